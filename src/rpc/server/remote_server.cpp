#include "rpc/server/remote_server.hpp"

#include <mutex>
#include <optional>

#include "core/clock_wait.hpp"
#include "core/log.hpp"
#include "core/threads/sole_owner.hpp"
#include "idl/left_out.hpp"
#include "remote_server_state.hpp"
#include "rpc/wire/common.hpp"
#include "rpc/wire/reply_encoding.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

constexpr const char* kImpostor = "it is in the name of a client that did not send it";

bool is_reserved(std::uint32_t operation) {
  return operation == wire::kOpen || operation == wire::kCancel || operation == wire::kCredit;
}

std::string unreadable(const std::string& what, const std::exception& why) {
  return what + " cannot be read: " + why.what() +
         "; the network damaged it, or the two sides were built from different IDL";
}

// Returns the offset of the value's end.
std::size_t decode(const TypeSupport& type, void* value, const calls::Message& message,
                   std::size_t offset) {
  if (!message.lent) return type.decode(value, message.bytes, offset);
  if (message.lent->value.empty()) {
    throw Overloaded("what the call lends cannot be read here; its provider's log says why");
  }
  idl::PuttingIn putting_in(message.lent->value, message.lent->position);
  const std::size_t end = type.decode(value, message.bytes, offset);
  if (!putting_in.taken()) throw InvalidArgument("what it lends belongs to no parameter");
  return end;
}

// Of the time that the caller gave, what is left after the way here. If that is none, the service
// drops the request as expired.
Duration remaining(RemoteClient& client, const wire::RequestTrailer& trailer, Instant arrived) {
  if (trailer.sent == Duration::zero()) return trailer.remaining;
  return trailer.remaining - client.transit.excess(trailer.sent, arrived);
}

}  // namespace

RemoteServer::State::State(calls::ProviderPort& port, Executor& control, Clock& clock_,
                           std::shared_ptr<Service> service_, Options options_)
    : clock(clock_),
      service(std::move(service_)),
      options(std::move(options_)),
      address{std::string(service->interface_info().name), service->id(),
              service->interface_info().representation()},
      sessions(std::make_shared<Sessions>(port, *service, active, control, clock,
                                          [this] { note_less_to_do(); })) {}

void RemoteServer::State::on_message(const calls::Message& message) {
  wire::RequestHead head;
  try {
    head = wire::read_request_head(message.bytes);
  } catch (const Error& error) {
    return on_unreadable(message, error);
  }
  on_request(message, head);
}

void RemoteServer::State::drop_malformed(const std::string& why) {
  if (malformed++ > 0) return;
  log(LogLevel::Warning, address.service, "dropped a malformed request: " + why);
}

// A client whose request was damaged is told, if it can be seen which one that was.
void RemoteServer::State::on_unreadable(const calls::Message& message, const Error& why) {
  drop_malformed(why.what());
  const auto id = wire::read_request_id(message.bytes);
  if (!id || id->client != message.sender) return;
  const auto client = sessions->find(id->client);
  if (client) refuse(*client, *id, ErrorCode::InvalidArgument, unreadable("a request", why));
}

// The client that is to be answered; null if the request is not to be executed. A Skein client's
// identity is that of its sender: nobody speaks for another. That is known before its arguments are
// decoded, which may cost much.
RemoteServer::State::Client RemoteServer::State::client_of(const calls::Message& message,
                                                           const wire::RequestHead& head) {
  const bool own_name = message.sender == head.id.client;
  auto client = sessions->find(head.id.client);
  if (own_name && client && !client->refusal) return client;
  const bool skein_client = client || wire::ends_with_trailer(message.bytes);
  if (!own_name && (skein_client || !foreign)) {
    drop_malformed(kImpostor);
    return nullptr;
  }
  if (!skein_client && foreign) return foreign;
  ++unconnected;
  if (skein_client) sessions->announce({head.id});
  return nullptr;
}

void RemoteServer::State::on_request(const calls::Message& message, const wire::RequestHead& head) {
  const Instant arrived = clock.now();
  received.fetch_add(1, std::memory_order_relaxed);
  if (is_reserved(head.operation) && wire::ends_with_trailer(message.bytes)) {
    return on_reserved(message, head);
  }
  const auto client = client_of(message, head);
  if (!client) return;
  try {
    accept(message, read_request(message, head, arrived, client));
  } catch (const Error& error) {
    refuse(*client, head.id, error.code(), error.what());
  } catch (const std::exception& error) {
    refuse(*client, head.id, ErrorCode::Internal, error.what());
  }
}

std::shared_ptr<RemoteServer::State::Request> RemoteServer::State::read_request(
    const calls::Message& message, const wire::RequestHead& head, Instant arrived,
    const Client& client) {
  const OperationInfo* operation = service->interface_info().find_operation(head.operation);
  if (!operation) {
    throw Unimplemented(address.service + " has no operation with hash " +
                        std::to_string(head.operation));
  }
  auto request = make_shared_in_call_memory<Request>();
  request->operation = operation;
  request->in = {operation->in->make(), operation->in->destroy};
  std::optional<wire::RequestTrailer> trailer;
  try {
    const std::size_t end = decode(*operation->in, request->in.get(), message, head.body);
    trailer = wire::read_request_trailer(message.bytes, end);
    if (trailer.has_value() != (client != foreign)) throw InvalidArgument("its end is damaged");
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(unreadable("the request of " + std::string(operation->name), error));
  }
  if (message.lent) request->lent = message.lent->use;
  request->caller = head.id.client;
  request->connection = message.sender;
  request->number = head.id.number;
  request->deadline = saturating_sum(arrived, trailer ? remaining(*client, *trailer, arrived)
                                                      : Duration(options.default_deadline));
  if (trailer) request->chain = std::move(trailer->chain);
  request->session = client->session;
  request->server = weak_from_this();
  request->client = client;
  request->id = head.id;
  request->respond = [request = request.get()](const void* out, const std::exception_ptr& error) {
    if (const auto self = request->server.lock()) self->respond(*request, out, error);
  };
  if (operation->stream) {
    request->stream = std::make_shared<OutgoingStream>(
        *operation, clock, request->deadline, trailer ? trailer->credit : 0,
        [request = request.get()](const void* out, std::uint64_t position) {
          if (const auto self = request->server.lock()) self->send_item(*request, out, position);
        });
  }
  return request;
}

// A client that leaves meanwhile is seen to be gone here, or its request is found when it leaves;
// the same goes for the service.
void RemoteServer::State::accept(const calls::Message& message,
                                 const std::shared_ptr<Request>& request) {
  active.add(request->id, request);
  if (options.on_load) options.on_load();
  try {
    if (request->client->gone) {
      ++unconnected;
      return forget(*request);
    }
    if (leaving && request->client == foreign) {
      throw Unavailable(address.service + " is being withdrawn");
    }
    std::function<bool()> may_run;
    if (message.turn) may_run = [turn = message.turn] { return turn->leave(); };
    service->submit(request, may_run);
  } catch (...) {
    forget(*request);
    throw;
  }
}

void RemoteServer::State::on_reserved(const calls::Message& message,
                                      const wire::RequestHead& head) {
  if (message.sender != head.id.client) return drop_malformed(kImpostor);
  std::optional<wire::RequestTrailer> trailer;
  try {
    trailer = wire::read_request_trailer(message.bytes, head.body + 1);
  } catch (const Error& error) {
    return drop_malformed(error.what());
  }
  if (!trailer) return drop_malformed("its end is damaged");
  if (head.operation == wire::kOpen) {
    Newcomer newcomer{head.id, true, std::move(trailer->strategy), {}};
    if (trailer->sent != Duration::zero()) newcomer.transit.excess(trailer->sent, clock.now());
    return sessions->announce(std::move(newcomer));
  }
  const auto call = active.find({head.id.client, trailer->target});
  if (!call) return;
  if (head.operation == wire::kCancel) {
    call->cancel();
  } else if (call->stream) {
    call->stream->grant(trailer->credit);
  }
}

void RemoteServer::State::refuse(RemoteClient& client, const wire::RequestId& id, ErrorCode code,
                                 std::string text) {
  ++refused;
  client.replies->refuse(id, code, std::move(text));
}

void RemoteServer::State::respond(Request& request, const void* out,
                                  const std::exception_ptr& error) {
  const OperationInfo& operation = *request.operation;
  const auto sender = request.client->replies->sender();  // which a server that ends waits for
  forget(request);
  if (operation.oneway) return;
  thread_local Bytes message;
  if (out || error) {
    encode_outcome(message, address.representation, request.id, operation, out, error);
  } else {
    encode_end(message, address.representation, request.id, operation, request.stream->sent());
  }
  request.client->replies->send(sender, message, request.deadline);
  if (message.capacity() > kKeptCapacity) message = Bytes();
}

void RemoteServer::State::send_item(const Request& request, const void* out,
                                    std::uint64_t position) {
  thread_local Bytes message;
  encode_item(message, address.representation, request.id, *request.operation, out, position);
  ReplyPath& replies = *request.client->replies;
  const bool sent = replies.send(replies.sender(), message, request.deadline);
  if (message.capacity() > kKeptCapacity) message = Bytes();
  if (!sent) throw Overloaded("the caller of " + quoted(*request.operation) + " takes no replies");
}

// The call is over.
void RemoteServer::State::forget(const Request& request) {
  active.remove(request.id, request);
  note_less_to_do();
  if (options.on_load) options.on_load();
}

void RemoteServer::State::note_less_to_do() {
  if (!leaving) return;
  std::lock_guard lock(mutex);
  less_to_do.notify_all();
}

RemoteServer::RemoteServer(calls::ProviderPort& port, Executor& control, Clock& clock,
                           std::shared_ptr<Service> service, const Options& options)
    : state_(std::make_shared<State>(port, control, clock, std::move(service), options)) {
  State& state = *state_;
  if (options.foreign_clients) state.foreign = state.sessions->open_foreign();
  try {
    state.requests = port.receive_requests(
        state.address, options.foreign_clients,
        {[&state](const calls::Message& message) { state.on_message(message); },
         [&state](const Guid& sender, bool found) { state.sessions->on_sender(sender, found); }});
  } catch (...) {
    state.sessions->end();
    await_sole_owner(state.sessions);
    throw;
  }
}

RemoteServer::~RemoteServer() {
  // Clients learn of the receiver's end before a call that is told to end could answer them.
  state_->requests.reset();
  state_->service->close();
  state_->sessions->end();
  await_sole_owner(state_);
  await_sole_owner(state_->sessions);
}

std::shared_ptr<calls::CallerDelivery> RemoteServer::delivery() const {
  return state_->requests->caller_delivery();
}

bool RemoteServer::await_clients_gone(Instant deadline) {
  std::unique_lock lock(state_->mutex);
  state_->leaving = true;
  return wait_until(state_->clock, deadline, lock, state_->less_to_do, [&] {
    return state_->sessions->counts().connected == 0 && state_->active.size() == 0;
  });
}

RemoteServer::Counters RemoteServer::counters() const {
  const Sessions::Counts sessions = state_->sessions->counts();
  return {state_->received,     state_->malformed, state_->refused,    state_->unconnected,
          sessions.turned_away, sessions.lost,     sessions.connected, state_->active.size()};
}

}  // namespace skein::rpc
