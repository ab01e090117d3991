#include "skein/rpc/dds_server.hpp"

#include <mutex>
#include <unordered_map>

#include "skein/core/error.hpp"
#include "skein/core/interface_name.hpp"
#include "skein/core/log.hpp"
#include "skein/rpc/wire.hpp"

namespace skein::rpc {
namespace {

using wire::RequestId;

// How long an opened client may take to match its reply reader before it is forgotten.
constexpr std::chrono::seconds kOpenPatience{10};

dds::Qos call_qos(std::vector<std::string> partitions) {
  dds::Qos qos;
  qos.partitions = std::move(partitions);
  return qos;
}

void encode_error(Bytes& message, const RequestId& id, ErrorCode code, const std::string& text) {
  wire::begin_reply(message, id, wire::remote_exception_of(code), 0);
  wire::append_default_branch(message);
  wire::append_trailer(message, wire::ReplyTrailer{code, text});
}

bool declares(const OperationInfo& operation, const ExceptionInfo& exception) {
  for (const ExceptionInfo* declared : operation.raises) {
    if (declared->hash == exception.hash) return true;
  }
  return false;
}

void encode_outcome(Bytes& message, const RequestId& id, const OperationInfo& operation,
                    const void* out, const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
    wire::begin_reply(message, id, wire::RemoteException::Ok, operation.hash);
    wire::append_discriminator(message, 0);
    operation.out->encode(out, message);
  } catch (const UserException& exception) {
    if (!declares(operation, exception.info())) {
      return encode_error(message, id, ErrorCode::Internal,
                          std::string(operation.name) + " threw " + std::string(exception.info().name) +
                              ", which its interface does not declare");
    }
    wire::begin_reply(message, id, wire::RemoteException::Ok, operation.hash);
    wire::append_discriminator(message, exception.info().hash);
    exception.info().type->encode(exception.value(), message);
  } catch (const Error& failure) {
    encode_error(message, id, failure.code(), failure.what());
  } catch (const std::exception& failure) {
    encode_error(message, id, ErrorCode::Internal,
                 std::string(operation.name) + " failed: " + failure.what());
  } catch (...) {
    encode_error(message, id, ErrorCode::Internal,
                 std::string(operation.name) + " threw something that is no std::exception");
  }
}

}  // namespace

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

struct DdsServer::State : std::enable_shared_from_this<State> {
  struct Client {
    std::unique_ptr<dds::Writer> writer;
    std::shared_ptr<Session> session;
    std::exception_ptr refusal;  // what the Head threw instead of making a session
    RequestId open;
    bool matched = false;
  };

  State(dds::Participant& participant_, Executor& control_, Clock& clock_,
        std::shared_ptr<Service> service_, Options options_)
      : participant(participant_),
        control(control_),
        clock(clock_),
        service(std::move(service_)),
        options(options_),
        address{std::string(service->interface_info().name), service->id()} {}

  dds::Participant& participant;
  Executor& control;
  Clock& clock;
  const std::shared_ptr<Service> service;
  const Options options;
  const DdsAddress address;

  mutable std::mutex mutex;
  std::unordered_map<Guid, std::shared_ptr<Client>> clients;
  std::unordered_map<Guid, std::unordered_map<std::uint64_t, std::shared_ptr<Invocation>>> active;
  std::shared_ptr<Client> foreign;
  Counters counters;
  std::unique_ptr<dds::Reader> requests;  // last: goes first, and no listener runs after that

  // The last to let go of a client may be a vendor's thread, which must not destroy its writer.
  std::shared_ptr<Client> make_client() {
    return {new Client, [&control = control](Client* client) {
              const std::shared_ptr<Client> owned(client);
              control.post([owned] {});
            }};
  }

  // ---- on the vendor's thread

  void on_sample(const dds::Sample& sample) {
    if (sample.state != dds::InstanceState::Alive) return;
    wire::RequestHead head;
    try {
      head = wire::read_request_head(sample.cdr);
    } catch (const Error& error) {
      std::lock_guard lock(mutex);
      if (++counters.malformed == 1) {
        log(LogLevel::Warning, address.service, std::string("dropped a malformed request: ") + error.what());
      }
      return;
    }
    try {
      on_request(sample.cdr, head);
    } catch (const Error& error) {
      refuse(head.id, error.code(), error.what());
    }
  }

  void on_request(std::span<const std::byte> message, const wire::RequestHead& head) {
    {
      std::lock_guard lock(mutex);
      ++counters.received;
    }
    const OperationInfo* operation = service->interface_info().find_operation(head.operation);
    if (!operation) return on_reserved(message, head);

    auto invocation = std::make_shared<Invocation>();
    invocation->operation = operation;
    invocation->in = {operation->in->make(), operation->in->destroy};
    const std::size_t end = operation->in->decode(invocation->in.get(), message, head.body);
    auto trailer = wire::read_request_trailer(message, end);
    invocation->caller = head.id.client;
    invocation->deadline = clock.now() + (trailer ? trailer->remaining : options.default_deadline);
    if (trailer) invocation->chain = std::move(trailer->chain);

    const auto client = client_of(head.id, trailer.has_value());
    if (!client) return;
    invocation->session = client->session;
    invocation->respond = [state = weak_from_this(), client, id = head.id, operation](
                              const void* out, std::exception_ptr error) {
      if (const auto self = state.lock()) self->respond(*client, id, *operation, out, error);
    };
    {
      std::lock_guard lock(mutex);
      active[head.id.client].emplace(head.id.number, invocation);
    }
    try {
      service->submit(invocation);
    } catch (...) {
      forget(head.id);
      throw;
    }
  }

  void on_reserved(std::span<const std::byte> message, const wire::RequestHead& head) {
    auto trailer = wire::read_request_trailer(message, head.body + 1);
    if (trailer && head.operation == wire::kOpen) {
      control.post([state = weak_from_this(), id = head.id, strategy = trailer->strategy] {
        if (const auto self = state.lock()) self->open(id, strategy);
      });
    } else if (trailer && head.operation == wire::kCancel) {
      std::lock_guard lock(mutex);
      const auto calls = active.find(head.id.client);
      if (calls == active.end()) return;
      if (const auto call = calls->second.find(trailer->target); call != calls->second.end()) {
        call->second->cancelled = true;
      }
    } else {
      refuse(head.id, ErrorCode::Unimplemented,
             address.service + " has no operation with hash " + std::to_string(head.operation));
    }
  }

  std::shared_ptr<Client> client_of(const RequestId& id, bool skein_client) {
    std::lock_guard lock(mutex);
    if (!skein_client) {
      if (!foreign) ++counters.unconnected;
      return foreign;
    }
    const auto found = clients.find(id.client);
    if (found != clients.end()) return found->second;
    ++counters.unconnected;
    return nullptr;
  }

  // Vendor threads never write: the refusal leaves from `control`.
  void refuse(const RequestId& id, ErrorCode code, std::string text) {
    {
      std::lock_guard lock(mutex);
      ++counters.refused;
    }
    control.post([state = weak_from_this(), id, code, text = std::move(text)] {
      const auto self = state.lock();
      if (!self) return;
      const auto client = [&] {
        std::lock_guard lock(self->mutex);
        const auto found = self->clients.find(id.client);
        return found != self->clients.end() ? found->second : self->foreign;
      }();
      if (!client) return;
      Bytes message;
      if (code == ErrorCode::Unimplemented) {
        wire::begin_reply(message, id, wire::RemoteException::UnknownOperation, 0);
        wire::append_default_branch(message);
        wire::append_trailer(message, wire::ReplyTrailer{code, text});
      } else {
        encode_error(message, id, code, text);
      }
      self->write(*client, message);
    });
  }

  // ---- on the control executor

  void open(const RequestId& id, const std::string& strategy) {
    {
      std::lock_guard lock(mutex);
      if (const auto found = clients.find(id.client); found != clients.end()) {
        found->second->open = id;
        if (!found->second->matched) return;
      }
    }
    if (answer_open(id.client)) return;

    auto client = make_client();
    client->open = id;
    try {
      client->session = service->open({id.client, strategy});
    } catch (...) {
      client->refusal = std::current_exception();
    }
    {
      std::lock_guard lock(mutex);
      clients.emplace(id.client, client);
      counters.clients = clients.size();
    }
    dds::WriterListener listener;
    listener.on_matched = [state = weak_from_this(), key = id.client](const Guid&, bool matched) {
      if (const auto self = state.lock()) self->on_reply_reader(key, matched);
    };
    auto writer = participant.create_writer(address.reply_topic(), call_qos({id.client.hex()}),
                                            std::move(listener));
    {
      std::lock_guard lock(mutex);
      client->writer = std::move(writer);
    }
    answer_open(id.client);
    clock.call_after(kOpenPatience, [state = weak_from_this(), key = id.client] {
      if (const auto self = state.lock()) self->drop_unless_matched(key);
    });
  }

  // False where there is no such client; answers only a client whose reader would get the answer.
  bool answer_open(const Guid& key) {
    std::shared_ptr<Client> client;
    {
      std::lock_guard lock(mutex);
      const auto found = clients.find(key);
      if (found == clients.end()) return false;
      if (!found->second->matched || !found->second->writer) return true;
      client = found->second;
    }
    Bytes message;
    try {
      if (client->refusal) std::rethrow_exception(client->refusal);
      wire::begin_reply(message, client->open, wire::RemoteException::Ok, wire::kOpen);
      wire::append_default_branch(message);
    } catch (const Error& error) {
      encode_error(message, client->open, error.code(), error.what());
    } catch (const std::exception& error) {
      encode_error(message, client->open, ErrorCode::Internal, error.what());
    }
    write(*client, message);
    return true;
  }

  void on_reply_reader(const Guid& key, bool matched) {
    {
      std::lock_guard lock(mutex);
      const auto found = clients.find(key);
      if (found == clients.end()) return;
      found->second->matched = matched;
    }
    control.post([state = weak_from_this(), key, matched] {
      const auto self = state.lock();
      if (!self) return;
      if (matched) {
        self->answer_open(key);
      } else {
        self->drop(key);
      }
    });
  }

  void drop_unless_matched(const Guid& key) {
    {
      std::lock_guard lock(mutex);
      const auto found = clients.find(key);
      if (found == clients.end() || found->second->matched) return;
    }
    control.post([state = weak_from_this(), key] {
      if (const auto self = state.lock()) self->drop(key);
    });
  }

  // The client has gone: its session ends, and nobody waits for its calls any more.
  void drop(const Guid& key) {
    std::shared_ptr<Client> client;  // outlives the lock, which its writer's listener takes too
    std::lock_guard lock(mutex);
    const auto found = clients.find(key);
    if (found == clients.end()) return;
    client = std::move(found->second);
    clients.erase(found);
    counters.clients = clients.size();
    if (const auto calls = active.find(key); calls != active.end()) {
      for (auto& [number, invocation] : calls->second) invocation->cancelled = true;
    }
  }

  // ---- on the service's executor

  void respond(Client& client, const RequestId& id, const OperationInfo& operation, const void* out,
               const std::exception_ptr& error) {
    forget(id);
    if (operation.oneway) return;
    thread_local Bytes message;
    encode_outcome(message, id, operation, out, error);
    write(client, message);
    if (message.capacity() > kKeptCapacity) message = Bytes();
  }

  void forget(const RequestId& id) {
    std::lock_guard lock(mutex);
    const auto calls = active.find(id.client);
    if (calls == active.end()) return;
    calls->second.erase(id.number);
    if (calls->second.empty()) active.erase(calls);
  }

  void write(Client& client, const Bytes& message) {
    try {
      if (client.writer) client.writer->write(message);
    } catch (const Error& error) {
      log(LogLevel::Warning, address.service, std::string("a reply was lost: ") + error.what());
    }
  }

  static constexpr std::size_t kKeptCapacity = 4 << 20;
};

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
  state.requests = participant.create_reader(state.address.request_topic(),
                                             call_qos(std::move(partitions)), std::move(listener));
}

DdsServer::~DdsServer() {
  state_->requests.reset();
  state_->service->close();
  std::unordered_map<Guid, std::shared_ptr<State::Client>> clients;
  std::lock_guard lock(state_->mutex);
  clients.swap(state_->clients);
}

DdsServer::Counters DdsServer::counters() const {
  std::lock_guard lock(state_->mutex);
  return state_->counters;
}

}  // namespace skein::rpc
