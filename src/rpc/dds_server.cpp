#include "skein/rpc/dds_server.hpp"

#include <atomic>
#include <deque>
#include <mutex>
#include <set>
#include <unordered_map>
#include <vector>

#include "common.hpp"
#include "reply_encoding.hpp"
#include "skein/core/error.hpp"
#include "skein/core/interface_name.hpp"
#include "skein/core/log.hpp"
#include "skein/rpc/wire.hpp"
#include "transit_delay.hpp"

namespace skein::rpc {
namespace {

using wire::RequestId;

// How long an opened client may take to match its reply reader before it is forgotten.
constexpr std::chrono::seconds kOpenPatience{10};
// How many refusals may wait to be written to a client: no client that waits for them has more calls on
// its way (DdsChannel::Options::calls_in_flight).
constexpr std::size_t kMaxRefusals = 4096;
// How many clients that have gone are remembered, in case that one of them comes back.
constexpr std::size_t kMaxForgotten = 1024;

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
  struct Refusal {
    RequestId id;
    ErrorCode code;
    std::string text;
  };

  struct Client {
    std::shared_ptr<dds::Writer> writer;  // under the server's mutex; nothing once the server ends
    std::shared_ptr<Session> session;
    std::exception_ptr refusal;  // what the Head threw instead of making a session
    RequestId open;
    bool matched = false;
    TransitDelay transit;  // under the server's mutex, as are:
    std::deque<Refusal> refusals;
    bool refusing = false;  // a task of `control` is about to write them
    std::atomic<bool> stalled{false};  // did not take a reply in time
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
  std::set<Guid> forgotten;  // clients whose sessions have ended
  std::shared_ptr<Client> foreign;
  Counters counters;
  bool closed = false;
  std::unique_ptr<dds::Reader> requests;  // last: goes first, and no listener runs after that

  // The last to let go of a client may be a vendor's thread, which must not destroy its writer.
  std::shared_ptr<Client> make_client() {
    return {new Client, [&control = control](Client* client) {
              const std::shared_ptr<Client> owned(client);
              control.post_or_run([owned] {});
            }};
  }

  // ---- on the vendor's thread

  void on_sample(const dds::Sample& sample) {
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

  void drop_malformed(const std::string& why) {
    std::lock_guard lock(mutex);
    if (++counters.malformed == 1) {
      log(LogLevel::Warning, address.service, "dropped a malformed request: " + why);
    }
  }

  // A Skein client's identity is that of its request writer: nobody speaks for another.
  bool is_impostor(const dds::Sample& sample, const wire::RequestHead& head) {
    if (sample.writer == head.id.client) return false;
    drop_malformed("it is in the name of a client that did not send it");
    return true;
  }

  void on_request(const dds::Sample& sample, const wire::RequestHead& head) {
    const Instant arrived = clock.now();
    {
      std::lock_guard lock(mutex);
      ++counters.received;
    }
    const auto message = sample.cdr;
    const OperationInfo* operation = service->interface_info().find_operation(head.operation);
    if (!operation) return on_reserved(sample, head);

    auto invocation = std::make_shared<Invocation>();
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
    invocation->respond = [state = weak_from_this(), client, id = head.id, operation,
                           stream = invocation->stream](const void* out, std::exception_ptr error) {
      const auto self = state.lock();
      if (self) self->respond(*client, id, *operation, out, error, stream ? stream->sent() : 0);
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

  std::shared_ptr<OutgoingStream> make_stream(const std::shared_ptr<Client>& client,
                                              const RequestId& id, const Invocation& invocation,
                                              std::uint32_t credit) {
    const OperationInfo& operation = *invocation.operation;
    return std::make_shared<OutgoingStream>(operation, clock, invocation.deadline, credit,
                                            [state = weak_from_this(), client, id, &operation](
                                                const void* out, std::uint64_t position) {
                                              if (const auto self = state.lock())
                                                self->send_item(*client, id, operation, out,
                                                                position);
                                            });
  }

  void on_reserved(const dds::Sample& sample, const wire::RequestHead& head) {
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

  std::shared_ptr<Invocation> find_active(const RequestId& id) const {
    std::lock_guard lock(mutex);
    const auto calls = active.find(id.client);
    if (calls == active.end()) return nullptr;
    const auto call = calls->second.find(id.number);
    return call == calls->second.end() ? nullptr : call->second;
  }

  std::shared_ptr<Client> client_of(const RequestId& id, bool skein_client) {
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

  // Of the time that the caller gave, what is left after the way here. Where that is none, the service
  // drops the request as expired.
  Duration remaining(Client& client, const wire::RequestTrailer& trailer, Instant arrived) {
    if (trailer.sent == Duration::zero()) return trailer.remaining;
    std::lock_guard lock(mutex);
    return trailer.remaining - client.transit.excess(trailer.sent, arrived);
  }

  // Vendor threads never write: the refusal leaves from `control`, by one task for all that wait, which
  // finds room there whatever else does.
  void refuse(const RequestId& id, ErrorCode code, std::string text) {
    std::shared_ptr<Client> client;
    {
      std::lock_guard lock(mutex);
      ++counters.refused;
      const auto found = clients.find(id.client);
      client = found != clients.end() ? found->second : foreign;
      if (!client) return;
      if (client->refusals.size() >= kMaxRefusals) client->refusals.pop_front();
      client->refusals.push_back({id, code, std::move(text)});
      if (std::exchange(client->refusing, true)) return;
    }
    control.post_or_run([state = weak_from_this(), client] {
      if (const auto self = state.lock()) self->write_refusals(*client);
    });
  }

  // ---- on the control executor

  void write_refusals(Client& client) {
    std::deque<Refusal> refusals;
    {
      std::lock_guard lock(mutex);
      refusals.swap(client.refusals);
      client.refusing = false;
    }
    for (const auto& [id, code, text] : refusals) {
      Bytes message;
      if (code == ErrorCode::Unimplemented) {
        wire::begin_reply(message, id, wire::RemoteException::UnknownOperation, 0);
        wire::append_default_branch(message);
        wire::append_trailer(message, wire::ReplyTrailer{code, text});
      } else {
        encode_error(message, id, code, text);
      }
      write(client, message);
    }
  }

  void open(const RequestId& id, const std::string& strategy, const TransitDelay& transit) {
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
    client->transit = transit;
    try {
      client->session = service->open({id.client, strategy});
    } catch (...) {
      client->refusal = std::current_exception();
    }
    admit(id, client);
  }

  // This side forgot the client (it was stopped, or cut off), and the client did not notice: it
  // hears so once its reply reader is found. What it sent may be a repetition, so it is never
  // executed.
  void dismiss(const RequestId& id) {
    {
      std::lock_guard lock(mutex);
      if (const auto found = clients.find(id.client); found != clients.end())
        found->second->open = id;
    }
    if (answer_open(id.client)) return;
    auto client = make_client();
    client->open = id;
    client->refusal = std::make_exception_ptr(
        Disconnected("the session has ended, as the client was not heard of for its lease"));
    admit(id, client);
  }

  void admit(const RequestId& id, const std::shared_ptr<Client>& client) {
    try {
      make_reply_writer(id, client);
    } catch (const Error& error) {
      log(LogLevel::Error, address.service,
          std::string("a client cannot be answered: ") + error.what());
      return drop(id.client);
    }
    answer_open(id.client);
    clock.call_after(kOpenPatience, [state = weak_from_this(), key = id.client] {
      if (const auto self = state.lock()) self->drop_unless_matched(key);
    });
  }

  void make_reply_writer(const RequestId& id, const std::shared_ptr<Client>& client) {
    {
      std::lock_guard lock(mutex);
      clients.emplace(id.client, client);
    }
    dds::WriterListener listener;
    listener.on_matched = [state = weak_from_this(), key = id.client, weak = std::weak_ptr(client)](
                              const Guid&, bool matched) {
      const auto self = state.lock();
      const auto client = weak.lock();
      if (self && client) self->on_reply_reader(key, client, matched);
    };
    auto writer = participant.create_writer(address.reply_topic(), call_qos({id.client.hex()}),
                                            std::move(listener));
    const std::lock_guard lock(mutex);
    if (!closed) client->writer = std::move(writer);
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
      encode_error(message, client->open, error.code(), error.what(), wire::kOpen);
    } catch (const std::exception& error) {
      encode_error(message, client->open, ErrorCode::Internal, error.what(), wire::kOpen);
    }
    write(*client, message);
    return true;
  }

  void on_reply_reader(const Guid& key, const std::shared_ptr<Client>& client, bool matched) {
    {
      std::lock_guard lock(mutex);
      client->matched = matched;
    }
    control.post_or_run([state = weak_from_this(), key, client, matched] {
      const auto self = state.lock();
      if (!self) return;
      if (matched) {
        self->answer_open(key);
      } else if (self->is_current(key, client)) {
        self->drop(key);
      }
    });
  }

  bool is_current(const Guid& key, const std::shared_ptr<Client>& client) const {
    std::lock_guard lock(mutex);
    const auto found = clients.find(key);
    return found != clients.end() && found->second == client;
  }

  // A client that comes back after it was forgotten may not know that it was, and may wait for an
  // answer to what was lost meanwhile.
  void on_request_writer(const Guid& key, bool matched) {
    {
      std::lock_guard lock(mutex);
      if (!matched) {
        if (clients.contains(key)) remember_forgotten(key);
        return;
      }
      if (forgotten.erase(key) == 0) return;
    }
    control.post_or_run([state = weak_from_this(), key] {
      const auto self = state.lock();
      if (!self) return;
      self->drop(key);
      self->dismiss({key, 0});
    });
  }

  void remember_forgotten(const Guid& key) {
    if (forgotten.size() >= kMaxForgotten) forgotten.erase(forgotten.begin());
    forgotten.insert(key);
  }

  void drop_unless_matched(const Guid& key) {
    {
      std::lock_guard lock(mutex);
      const auto found = clients.find(key);
      if (found == clients.end() || found->second->matched) return;
    }
    control.post_or_run([state = weak_from_this(), key] {
      if (const auto self = state.lock()) self->drop(key);
    });
  }

  // The client has gone: its session ends, and nobody waits for its calls any more.
  void drop(const Guid& key) {
    std::shared_ptr<dds::Writer>
        writer;  // goes here, where its listener can be waited for, and unlocked
    std::shared_ptr<Client> client;
    std::lock_guard lock(mutex);
    const auto found = clients.find(key);
    if (found == clients.end()) return;
    client = std::move(found->second);
    writer = std::move(client->writer);
    clients.erase(found);
    remember_forgotten(key);
    if (const auto calls = active.find(key); calls != active.end()) {
      for (auto& [number, invocation] : calls->second) invocation->cancel();
    }
  }

  // ---- on the service's executor

  void respond(Client& client, const RequestId& id, const OperationInfo& operation, const void* out,
               const std::exception_ptr& error, std::uint64_t sent) {
    forget(id);
    if (operation.oneway) return;
    thread_local Bytes message;
    if (out || error) {
      encode_outcome(message, id, operation, out, error);
    } else {
      encode_end(message, id, operation, sent);
    }
    write(client, message);
    if (message.capacity() > kKeptCapacity) message = Bytes();
  }

  void send_item(Client& client, const RequestId& id, const OperationInfo& operation,
                 const void* out, std::uint64_t position) {
    thread_local Bytes message;
    encode_item(message, id, operation, out, position);
    const bool sent = write(client, message);
    if (message.capacity() > kKeptCapacity) message = Bytes();
    if (!sent)
      throw Overloaded("the caller of " + std::string(operation.name) + " takes no replies");
  }

  void forget(const RequestId& id) {
    std::lock_guard lock(mutex);
    const auto calls = active.find(id.client);
    if (calls == active.end()) return;
    calls->second.erase(id.number);
    if (calls->second.empty()) active.erase(calls);
  }

  std::shared_ptr<dds::Writer> writer_of(const Client& client) const {
    std::lock_guard lock(mutex);
    return client.writer;
  }

  // False where the reply was lost.
  bool write(Client& client, const Bytes& message) {
    using namespace std::chrono_literals;
    const auto writer = writer_of(client);
    if (!writer) return false;
    try {
      // A client that stopped reading may hold up this thread once, and not with each reply.
      if (client.stalled && !writer->wait_for_acknowledgments(0ms)) return false;
      client.stalled = false;
      writer->write(message);
      return true;
    } catch (const Error& error) {
      client.stalled = error.code() == ErrorCode::Overloaded;
      log(LogLevel::Warning, address.service, std::string("a reply was lost: ") + error.what());
      return false;
    }
  }
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
  for (const auto& [key, calls] : state_->active) counters.active += calls.size();
  return counters;
}

}  // namespace skein::rpc
