#include "skein/rpc/dds_server.hpp"

#include <mutex>
#include <vector>

#include "common.hpp"
#include "dds_server_state.hpp"
#include "skein/core/error.hpp"
#include "skein/core/interface_name.hpp"
#include "skein/core/log.hpp"

namespace skein::rpc {
namespace {

dds::Topic topic_of(const std::string& service, const char* suffix) {
  const std::string type = scoped_interface_name(service);
  std::string name = type;
  for (std::size_t at; (at = name.find("::")) != std::string::npos;) name.replace(at, 2, "/");
  return {name + suffix, type + suffix, false};
}

}  // namespace

dds::Topic DdsAddress::request_topic() const { return topic_of(service, "_Request"); }
dds::Topic DdsAddress::reply_topic() const { return topic_of(service, "_Reply"); }

std::vector<std::string> DdsAddress::partitions() const {
  return {provider.is_nil() ? std::string() : provider.hex()};
}

void DdsServer::State::on_sample(const dds::Sample& sample) {
  if (sample.state != dds::InstanceState::Alive) return;
  wire::RequestHead head;
  try {
    head = wire::read_request_head(sample.cdr);
  } catch (const Error& error) {
    return drop_malformed(error.what());
  }
  try {
    on_request(sample, head);
  } catch (const Error& error) {
    refuse(head.id, error.code(), error.what());
  } catch (const std::exception& error) {
    refuse(head.id, ErrorCode::Internal, error.what());
  }
}

void DdsServer::State::drop_malformed(const std::string& why) {
  std::lock_guard lock(mutex);
  if (++counters.malformed == 1) {
    log(LogLevel::Warning, address.service, "dropped a malformed request: " + why);
  }
}

// A Skein client's identity is that of its request writer: nobody speaks for another.
bool DdsServer::State::is_impostor(const dds::Sample& sample, const wire::RequestHead& head) {
  if (sample.writer == head.id.client) return false;
  drop_malformed("it is in the name of a client that did not send it");
  return true;
}

void DdsServer::State::on_request(const dds::Sample& sample, const wire::RequestHead& head) {
  const Instant arrived = clock.now();
  {
    std::lock_guard lock(mutex);
    ++counters.received;
  }
  const auto message = sample.cdr;
  const OperationInfo* operation = service->interface_info().find_operation(head.operation);
  if (!operation) return on_reserved(sample, head);

  auto invocation = make_shared_in_call_memory<Request>();
  invocation->operation = operation;
  invocation->in = {operation->in->make(), operation->in->destroy};
  const std::size_t end = operation->in->decode(invocation->in.get(), message, head.body);
  auto trailer = wire::read_request_trailer(message, end);
  if (trailer && is_impostor(sample, head)) return;
  invocation->caller = head.id.client;
  invocation->connection = head.id.client;
  invocation->number = head.id.number;

  const auto client = client_of(head.id, trailer.has_value());
  if (!client) return;
  invocation->deadline =
      arrived + (trailer ? remaining(*client, *trailer, arrived) : options.default_deadline);
  if (trailer) invocation->chain = std::move(trailer->chain);
  invocation->session = client->session;
  if (operation->stream) {
    invocation->stream = make_stream(client, head.id, *invocation, trailer ? trailer->credit : 0);
  }
  invocation->server = weak_from_this();
  invocation->client = client;
  invocation->id = head.id;
  invocation->respond = [request = invocation.get()](const void* out, std::exception_ptr error) {
    if (const auto self = request->server.lock()) self->respond(*request, out, error);
  };
  {
    std::lock_guard lock(mutex);
    active.emplace(head.id, invocation);
  }
  if (options.on_load) options.on_load();
  try {
    service->submit(invocation);
  } catch (...) {
    forget(head.id);
    throw;
  }
}

std::shared_ptr<OutgoingStream> DdsServer::State::make_stream(const std::shared_ptr<Client>& client,
                                                              const RequestId& id,
                                                              const Invocation& invocation,
                                                              std::uint32_t credit) {
  const OperationInfo& operation = *invocation.operation;
  return std::make_shared<OutgoingStream>(
      operation, clock, invocation.deadline, credit,
      [state = weak_from_this(), client, id, &operation](const void* out, std::uint64_t position) {
        if (const auto self = state.lock()) self->send_item(*client, id, operation, out, position);
      });
}

void DdsServer::State::on_reserved(const dds::Sample& sample, const wire::RequestHead& head) {
  auto trailer = wire::read_request_trailer(sample.cdr, head.body + 1);
  if (trailer && is_impostor(sample, head)) return;
  if (trailer && head.operation == wire::kOpen) {
    TransitDelay transit;
    if (trailer->sent != Duration::zero()) transit.excess(trailer->sent, clock.now());
    control.post([state = weak_from_this(), id = head.id, strategy = trailer->strategy, transit] {
      if (const auto self = state.lock()) self->open(id, strategy, transit);
    });
  } else if (trailer && head.operation == wire::kCancel) {
    if (const auto call = find_active({head.id.client, trailer->target})) call->cancel();
  } else if (trailer && head.operation == wire::kCredit) {
    const auto call = find_active({head.id.client, trailer->target});
    if (call && call->stream) call->stream->grant(trailer->credit);
  } else {
    refuse(head.id, ErrorCode::Unimplemented,
           address.service + " has no operation with hash " + std::to_string(head.operation));
  }
}

std::shared_ptr<Invocation> DdsServer::State::find_active(const RequestId& id) const {
  std::lock_guard lock(mutex);
  const auto call = active.find(id);
  return call == active.end() ? nullptr : call->second;
}

std::shared_ptr<DdsServer::State::Client> DdsServer::State::client_of(const RequestId& id,
                                                                      bool skein_client) {
  std::lock_guard lock(mutex);
  if (!skein_client) {
    if (!foreign) ++counters.unconnected;
    return foreign;
  }
  const auto found = clients.find(id.client);
  if (found != clients.end() && !found->second->refusal) return found->second;
  ++counters.unconnected;
  control.post([state = weak_from_this(), id] {
    if (const auto self = state.lock()) self->dismiss(id);
  });
  return nullptr;
}

// Of the time that the caller gave, what is left after the way here. Where that is none, the
// service drops the request as expired.
Duration DdsServer::State::remaining(Client& client, const wire::RequestTrailer& trailer,
                                     Instant arrived) {
  if (trailer.sent == Duration::zero()) return trailer.remaining;
  std::lock_guard lock(mutex);
  return trailer.remaining - client.transit.excess(trailer.sent, arrived);
}

DdsServer::DdsServer(dds::Participant& participant, Executor& control, Clock& clock,
                     std::shared_ptr<Service> service, Options options)
    : state_(std::make_shared<State>(participant, control, clock, std::move(service), options)) {
  State& state = *state_;
  if (options.foreign_clients) {
    state.foreign = state.make_client();
    state.foreign->writer = participant.create_writer(state.address.reply_topic(), call_qos({""}));
  }
  std::vector<std::string> partitions = state.address.partitions();
  if (options.foreign_clients) partitions.push_back("");
  dds::ReaderListener listener;
  listener.on_data = [&state](dds::Reader& reader) {
    reader.take([&state](const dds::Sample& sample) { state.on_sample(sample); });
  };
  listener.on_matched = [&state](const Guid& writer, bool matched) {
    state.on_request_writer(writer, matched);
  };
  state.requests = participant.create_reader(state.address.request_topic(),
                                             call_qos(std::move(partitions)), std::move(listener));
}

DdsServer::~DdsServer() {
  state_->requests.reset();
  state_->service->close();
  // The writers end here, where their listeners can be waited for: a listener that still runs may
  // be the last to let go of its client, and of the state.
  std::vector<std::shared_ptr<dds::Writer>> writers;
  std::unordered_map<Guid, std::shared_ptr<State::Client>> clients;
  std::lock_guard lock(state_->mutex);
  state_->closed = true;
  clients.swap(state_->clients);
  for (const auto& [key, client] : clients) writers.push_back(std::move(client->writer));
  if (state_->foreign) writers.push_back(std::move(state_->foreign->writer));
}

DdsServer::Counters DdsServer::counters() const {
  std::lock_guard lock(state_->mutex);
  Counters counters = state_->counters;
  for (const auto& [key, client] : state_->clients) counters.clients += client->refusal ? 0 : 1;
  counters.active = state_->active.size();
  return counters;
}

}  // namespace skein::rpc
