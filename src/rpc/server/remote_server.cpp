#include "rpc/server/remote_server.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <vector>

#include "core/clock_wait.hpp"
#include "core/log.hpp"
#include "core/threads/sole_owner.hpp"
#include "idl/left_out.hpp"
#include "remote_server_state.hpp"
#include "rpc/wire/common.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

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

}  // namespace

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
  std::lock_guard lock(mutex);
  if (++counters.malformed == 1) {
    log(LogLevel::Warning, address.service, "dropped a malformed request: " + why);
  }
}

void RemoteServer::State::drop_impostor() {
  drop_malformed("it is in the name of a client that did not send it");
}

// A client whose request was damaged hears so, where it can be seen which one that was.
void RemoteServer::State::on_unreadable(const calls::Message& message, const Error& why) {
  drop_malformed(why.what());
  const auto id = wire::read_request_id(message.bytes);
  if (!id || id->client != message.sender) return;
  std::shared_ptr<Client> client;
  {
    std::lock_guard lock(mutex);
    const auto found = clients.find(id->client);
    if (found == clients.end()) return;
    client = found->second;
  }
  refuse(client, *id, ErrorCode::InvalidArgument, unreadable("a request", why));
}

// Who is to be answered; nobody where the request is not to be executed. A Skein client's identity
// is that of its sender: nobody speaks for another. That is known before its arguments are
// decoded, which may cost much.
std::shared_ptr<RemoteServer::State::Client> RemoteServer::State::client_of(
    const calls::Message& message, const wire::RequestHead& head) {
  const bool own_name = message.sender == head.id.client;
  bool known;
  {
    std::lock_guard lock(mutex);
    const auto found = clients.find(head.id.client);
    known = found != clients.end();
    if (own_name && known && !found->second->refusal) return found->second;
  }
  const bool skein_client = known || wire::ends_with_trailer(message.bytes);
  if (!own_name && (skein_client || !foreign)) {
    drop_impostor();
    return nullptr;
  }
  if (!skein_client && foreign) return foreign;
  {
    std::lock_guard lock(mutex);
    ++counters.unconnected;
  }
  if (skein_client) announce({head.id});
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
    accept(message, head, arrived, client);
  } catch (const Error& error) {
    refuse(client, head.id, error.code(), error.what());
  } catch (const std::exception& error) {
    refuse(client, head.id, ErrorCode::Internal, error.what());
  }
}

void RemoteServer::State::accept(const calls::Message& message, const wire::RequestHead& head,
                                 Instant arrived, const std::shared_ptr<Client>& client) {
  const OperationInfo* operation = service->interface_info().find_operation(head.operation);
  if (!operation) {
    throw Unimplemented(address.service + " has no operation with hash " +
                        std::to_string(head.operation));
  }
  auto invocation = make_shared_in_call_memory<Request>();
  invocation->operation = operation;
  invocation->in = {operation->in->make(), operation->in->destroy};
  std::optional<wire::RequestTrailer> trailer;
  try {
    const std::size_t end = decode(*operation->in, invocation->in.get(), message, head.body);
    trailer = wire::read_request_trailer(message.bytes, end);
    if (trailer.has_value() != (client != foreign)) throw InvalidArgument("its end is damaged");
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(unreadable("the request of " + std::string(operation->name), error));
  }
  if (message.lent) invocation->lent = message.lent->use;
  invocation->caller = head.id.client;
  invocation->connection = message.sender;
  invocation->number = head.id.number;
  invocation->deadline = saturating_sum(arrived, trailer ? remaining(*client, *trailer, arrived)
                                                         : Duration(options.default_deadline));
  if (trailer) invocation->chain = std::move(trailer->chain);
  invocation->session = client->session;
  if (operation->stream) {
    invocation->stream = make_stream(client, head.id, *invocation, trailer ? trailer->credit : 0);
  }
  invocation->server = weak_from_this();
  invocation->client = client;
  invocation->id = head.id;
  invocation->respond = [request = invocation.get()](const void* out,
                                                     const std::exception_ptr& error) {
    if (const auto self = request->server.lock()) self->respond(*request, out, error);
  };
  {
    std::lock_guard lock(mutex);
    // A client that has left since is not there to be cancelled: drop() has looked at `active`.
    if (!is_known(head.id.client, client)) {
      ++counters.unconnected;
      return;
    }
    if (leaving && client == foreign) throw Unavailable(address.service + " is being withdrawn");
    active.emplace(head.id, invocation);
  }
  if (options.on_load) options.on_load();
  try {
    std::function<bool()> may_run;
    if (message.turn) may_run = [turn = message.turn] { return turn->leave(); };
    service->submit(invocation, may_run);
  } catch (...) {
    forget(*invocation);
    throw;
  }
}

std::shared_ptr<OutgoingStream> RemoteServer::State::make_stream(
    const std::shared_ptr<Client>& client, const RequestId& id, const Invocation& invocation,
    std::uint32_t credit) {
  const OperationInfo& operation = *invocation.operation;
  return std::make_shared<OutgoingStream>(
      operation, clock, invocation.deadline, credit,
      [state = weak_from_this(), client, id, &operation, deadline = invocation.deadline](
          const void* out, std::uint64_t position) {
        const auto self = state.lock();
        if (self) self->send_item(client, id, operation, out, position, deadline);
      });
}

void RemoteServer::State::on_reserved(const calls::Message& message,
                                      const wire::RequestHead& head) {
  if (message.sender != head.id.client) return drop_impostor();
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
    return announce(std::move(newcomer));
  }
  const auto call = find_active({head.id.client, trailer->target});
  if (!call) return;
  if (head.operation == wire::kCancel) {
    call->cancel();
  } else if (call->stream) {
    call->stream->grant(trailer->credit);
  }
}

std::shared_ptr<Invocation> RemoteServer::State::find_active(const RequestId& id) const {
  std::lock_guard lock(mutex);
  const auto call = active.find(id);
  return call == active.end() ? nullptr : call->second;
}

// Of the time that the caller gave, what is left after the way here. Where that is none, the
// service drops the request as expired.
Duration RemoteServer::State::remaining(Client& client, const wire::RequestTrailer& trailer,
                                        Instant arrived) {
  if (trailer.sent == Duration::zero()) return trailer.remaining;
  std::lock_guard lock(mutex);
  return trailer.remaining - client.transit.excess(trailer.sent, arrived);
}

RemoteServer::RemoteServer(calls::ProviderPort& port, Executor& control, Clock& clock,
                           std::shared_ptr<Service> service, const Options& options)
    : state_(std::make_shared<State>(port, control, clock, std::move(service), options)) {
  State& state = *state_;
  if (options.foreign_clients) {
    state.foreign = state.make_client();
    state.foreign->sender =
        SharedUse::share(port.send_replies(state.address, Guid{}), state.senders.hold());
  }
  state.requests = port.receive_requests(
      state.address, options.foreign_clients,
      {[&state](const calls::Message& message) { state.on_message(message); },
       [&state](const Guid& sender, bool found) { state.on_request_sender(sender, found); }});
}

RemoteServer::~RemoteServer() {
  // Clients learn of the receiver's end before a call that is told to end could answer them.
  state_->requests.reset();
  state_->service->close();
  std::vector<TimerId> timers;
  {
    // The senders end here, where their listeners can be waited for: a listener that still runs may
    // be the last to let go of its client, and of the state.
    std::vector<std::shared_ptr<calls::Sender>> senders;
    std::unordered_map<Guid, std::shared_ptr<State::Client>> clients;
    std::lock_guard lock(state_->mutex);
    state_->closed = true;
    clients.swap(state_->clients);
    const auto end = [&](State::Client& client) {
      senders.push_back(std::move(client.sender));
      timers.insert(timers.end(), {client.patience, client.retry});
    };
    for (const auto& [key, client] : clients) end(*client);
    if (state_->foreign) end(*state_->foreign);
  }
  for (const TimerId timer : timers) state_->clock.cancel(timer);
  state_->senders.await_end();
  await_sole_owner(state_);
}

std::shared_ptr<calls::CallerDelivery> RemoteServer::delivery() const {
  return state_->requests->caller_delivery();
}

// Under the lock.
std::size_t RemoteServer::State::connected() const {
  return static_cast<std::size_t>(std::count_if(
      clients.begin(), clients.end(), [](const auto& each) { return !each.second->refusal; }));
}

bool RemoteServer::await_clients_gone(Instant deadline) {
  std::unique_lock lock(state_->mutex);
  state_->leaving = true;
  return wait_until(state_->clock, deadline, lock, state_->less_to_do,
                    [&] { return state_->connected() == 0 && state_->active.empty(); });
}

RemoteServer::Counters RemoteServer::counters() const {
  std::lock_guard lock(state_->mutex);
  Counters counters = state_->counters;
  counters.received = state_->received;
  counters.clients = state_->connected();
  counters.active = state_->active.size();
  return counters;
}

}  // namespace skein::rpc
