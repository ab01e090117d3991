#include "skein/rpc/dds_channel.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <unordered_map>

#include "common.hpp"
#include "reply_reading.hpp"
#include "skein/core/call_context.hpp"
#include "skein/core/error.hpp"
#include "skein/core/log.hpp"
#include "skein/core/stream.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/rpc/wire.hpp"

namespace skein::rpc {
namespace {

using wire::RequestId;

// DDS tells no one that the other side has matched, so `open` is repeated until it is answered.
constexpr std::chrono::milliseconds kOpenInterval{20};

}  // namespace

struct DdsChannel::State : std::enable_shared_from_this<State> {
  enum class Keep { Nothing, Streams };
  enum class Phase { Opening, Open, Lost, Closed };

  struct Entry {
    std::shared_ptr<PendingCall> call;
    TimerId timer = 0;
  };

  State(dds::Participant& participant_, Executor& control_, std::shared_ptr<Executor> continuations_,
        std::shared_ptr<Clock> clock_, DdsAddress address_, Options options_)
      : participant(participant_),
        control(control_),
        continuations(std::move(continuations_)),
        owned_clock(std::move(clock_)),
        clock(*owned_clock),
        address(std::move(address_)),
        options(std::move(options_)) {}

  dds::Participant& participant;
  Executor& control;
  const std::shared_ptr<Executor> continuations;
  const std::shared_ptr<Clock> owned_clock;
  Clock& clock;
  const DdsAddress address;
  const Options options;

  mutable std::mutex mutex;
  std::condition_variable changed;
  Phase phase = Phase::Opening;
  std::string lost_how;
  std::exception_ptr refusal;
  std::size_t matched_servers = 0;
  std::uint64_t last_number = 0;
  std::uint64_t malformed = 0;
  std::unordered_map<std::uint64_t, Entry> entries;
  Guid client;
  std::shared_ptr<dds::Writer> requests;
  std::shared_ptr<dds::Reader> replies;
  std::shared_ptr<void> companion;

  // ---- opening

  void create_endpoints() {
    dds::WriterListener listener;
    listener.on_matched = [state = weak_from_this()](const Guid&, bool matched) {
      if (const auto self = state.lock()) self->on_server(matched);
    };
    auto writer = participant.create_writer(address.request_topic(), call_qos(address.partitions()),
                                            std::move(listener));
    {
      std::lock_guard lock(mutex);
      client = writer->guid();
      requests = std::move(writer);
    }
    dds::ReaderListener reply_listener;
    reply_listener.on_data = [state = weak_from_this()](dds::Reader& reader) {
      const auto self = state.lock();
      if (self) reader.take([&](const dds::Sample& sample) { self->on_sample(sample); });
    };
    std::vector<std::string> partitions{client.hex()};
    if (address.provider.is_nil()) partitions.push_back("");
    auto reader = participant.create_reader(address.reply_topic(), call_qos(std::move(partitions)),
                                            std::move(reply_listener));
    std::lock_guard lock(mutex);
    replies = std::move(reader);
  }

  void await_open() {
    const Instant deadline = clock.now() + options.timeout;
    std::unique_lock lock(mutex);
    std::size_t greeted = 0;
    while (phase == Phase::Opening && !refusal) {
      if (clock.now() >= deadline) {
        throw Unavailable(
            options.peer + " did not answer within " +
            std::to_string(
                std::chrono::duration_cast<std::chrono::milliseconds>(options.timeout).count()) +
            " ms" +
            (matched_servers == 0 ? ": no provider's endpoint was found on this domain"
                                  : ": its endpoint was found, but it does not reply"));
      }
      greeted = matched_servers;
      lock.unlock();
      if (options.stands && !options.stands()) {
        throw Unavailable(options.peer + " left while it was being connected");
      }
      if (greeted > 0) send_open();
      lock.lock();
      changed.wait_for(lock, kOpenInterval, [&] {
        return phase != Phase::Opening || refusal || matched_servers != greeted;
      });
    }
    if (refusal) std::rethrow_exception(refusal);
    if (phase != Phase::Open)
      throw Unavailable(options.peer + " went away while it was being connected");
  }

  void send_open() {
    Bytes message;
    wire::begin_request(message, {client, 0}, wire::kOpen);
    wire::append_default_branch(message);
    wire::append_trailer(message,
                         wire::RequestTrailer{options.timeout, 0, {}, options.strategy, 0,
                                              clock.now().time_since_epoch()});
    requests->write(message);
  }

  // ---- on the vendor's threads

  void on_server(bool matched) {
    std::unique_lock lock(mutex);
    matched_servers += matched ? 1 : -1;
    changed.notify_all();
    if (matched || matched_servers > 0 || phase != Phase::Open) return;
    lock.unlock();
    lose("it left, or it was not heard of for longer than its lease");
  }

  void on_sample(const dds::Sample& sample) {
    if (sample.state != dds::InstanceState::Alive) return;
    try {
      const wire::ReplyHead head = wire::read_reply_head(sample.cdr);
      if (head.related.client != client) return;
      if (head.related.number == 0) {
        on_opened(sample.cdr, head);
      } else if (head.operation == wire::kOpen) {
        dismissed("it had ended the session before the call arrived");
      } else {
        on_reply(sample.cdr, head);
      }
    } catch (const std::exception& error) {
      note_malformed(error.what());
    }
  }

  void on_reply(std::span<const std::byte> message, const wire::ReplyHead& head) {
    const std::uint64_t number = head.related.number;
    const auto call = remove(number, Keep::Streams);
    if (!call) return;
    if (call->operation().stream) {
      on_stream_reply(number, static_cast<PendingStream&>(*call), message, head);
    } else {
      complete(*call, message, head);
    }
  }

  void note_malformed(const std::string& why) {
    std::lock_guard lock(mutex);
    if (++malformed == 1) {
      log(LogLevel::Warning, address.service, "malformed reply from " + options.peer + ": " + why);
    }
  }

  void on_opened(std::span<const std::byte> message, const wire::ReplyHead& head) {
    std::exception_ptr refused;
    // A server that is not built with Skein does not know `open`; that it says so proves it ready.
    const bool known = head.exception != wire::RemoteException::Ok &&
                       head.exception != wire::RemoteException::UnknownOperation;
    if (known) refused = error_in(message, head, "open", options.peer);
    {
      std::lock_guard lock(mutex);
      if (phase == Phase::Opening) {
        if (refused) {
          refusal = refused;
        } else {
          phase = Phase::Open;
        }
        changed.notify_all();
        return;
      }
    }
    if (refused) dismissed("it has ended the session, as this side was not heard of for its lease");
  }

  // In the default partition one of several servers may not know this client, and others do.
  void dismissed(const std::string& how) {
    if (!address.provider.is_nil()) lose(how);
  }

  void complete(PendingCall& call, std::span<const std::byte> message,
                const wire::ReplyHead& head) {
    if (!call.claim()) return;
    std::exception_ptr error;
    try {
      error = read_reply(call.operation(), call.out(), message, head, options.peer).error;
    } catch (const std::exception& malformed) {
      error = unreadable(call.operation(), malformed);
    }
    note_end(head.related.number, call.operation(), error);
    call.finish(std::move(error));
  }

  std::exception_ptr unreadable(const OperationInfo& operation, const std::exception& malformed) {
    note_malformed(malformed.what());
    return std::make_exception_ptr(Internal(options.peer + " answered " +
                                            std::string(operation.name) +
                                            " with what cannot be read: " + malformed.what()));
  }

  // What is wrong with a stream ends it, here and at the server.
  void on_stream_reply(std::uint64_t number, PendingStream& stream,
                       std::span<const std::byte> message, const wire::ReplyHead& head) {
    try {
      read_part(number, stream, message, head);
    } catch (const std::exception& malformed) {
      abandon(number);
      stream.fail(unreadable(stream.operation(), malformed));
    }
  }

  void read_part(std::uint64_t number, PendingStream& stream, std::span<const std::byte> message,
                 const wire::ReplyHead& head) {
    const TypeSupport& type = *stream.operation().out;
    PendingStream::Item item(type.make(), type.destroy);
    Reply reply = read_reply(stream.operation(), item.get(), message, head, options.peer);
    if (!reply.error && reply.part != wire::StreamPart::None &&
        reply.position != stream.delivered()) {
      throw InvalidArgument("result " + std::to_string(stream.delivered()) +
                            " of the stream is missing");
    }
    if (!reply.error && reply.part != wire::StreamPart::End && !stream.deliver(std::move(item))) {
      throw InvalidArgument("it is a result more than was asked for");
    }
    if (reply.part == wire::StreamPart::Item) return;
    remove(number);
    if (!stream.claim()) return;
    note_end(number, stream.operation(), reply.error);
    stream.finish(std::move(reply.error));
  }

  void note_end(std::uint64_t number, const OperationInfo& operation, const std::exception_ptr& error) {
    if (options.journal) options.journal->note_end(false, client, number, address.service, operation, error);
  }

  // ---- calls

  void start(const std::shared_ptr<PendingCall>& call, const void* in) {
    if (options.spin.count() > 0) call->set_spin(options.spin);
    std::uint64_t number = 0;
    bool sent = false;
    call->attempt([&] {
      const auto writer = enter(call, number);
      send(*writer, *call, number, in);
      sent = true;
    });
    if (!sent || call->operation().oneway) remove(number);
    if (sent && call->operation().oneway && call->claim()) call->finish();
  }

  // The call is known before its request leaves: a reply may be here before write() returns.
  std::shared_ptr<dds::Writer> enter(const std::shared_ptr<PendingCall>& call,
                                     std::uint64_t& number) {
    std::lock_guard lock(mutex);
    if (phase == Phase::Lost) throw Unavailable("no connection to " + options.peer + ": " + lost_how);
    if (phase != Phase::Open) throw Unavailable("no connection to " + options.peer + ": disconnected");
    if (entries.size() >= options.calls_in_flight) {
      throw Overloaded(std::to_string(options.calls_in_flight) + " calls to " + options.peer +
                       " already wait for their answers; the call was not sent");
    }
    number = ++last_number;
    Entry& entry = entries[number];
    entry.call = call;
    entry.timer = clock.call_at(call->deadline(), [state = weak_from_this(), number] {
      if (const auto self = state.lock()) self->expire(number);
    });
    if (!call->blocking()) {
      call->set_canceller([state = weak_from_this(), number] {
        if (const auto self = state.lock()) self->abandon(number);
      });
    }
    if (call->operation().stream) {
      static_cast<PendingStream&>(*call).set_granter(
          [state = weak_from_this(), number](std::uint32_t count) {
            if (const auto self = state.lock()) self->grant(number, count);
          });
    }
    return requests;
  }

  void send(dds::Writer& writer, const PendingCall& call, std::uint64_t number, const void* in) {
    thread_local Bytes message;
    wire::begin_request(message, {client, number}, call.operation().hash);
    call.operation().in->encode(in, message);
    const Instant now = clock.now();
    wire::append_trailer(
        message, wire::RequestTrailer{call.deadline() - now,
                                      0,
                                      call.blocking() ? inherited_chain() : std::vector<Guid>(),
                                      {},
                                      call.operation().stream ? PendingStream::kWindow : 0,
                                      now.time_since_epoch()});
    if (options.journal) {
      options.journal->note(introspection::CallStep::Sent, client, number, address.service, call.operation());
    }
    writer.write(message);
    if (message.capacity() > kKeptCapacity) message = Bytes();
  }

  // The call, which is not known by its number any more; a stream stays known until its last reply.
  std::shared_ptr<PendingCall> remove(std::uint64_t number, Keep keep = Keep::Nothing) {
    Entry entry;
    {
      std::lock_guard lock(mutex);
      const auto found = entries.find(number);
      if (found == entries.end()) return nullptr;
      if (keep == Keep::Streams && found->second.call->operation().stream)
        return found->second.call;
      entry = std::move(found->second);
      entries.erase(found);
    }
    clock.cancel(entry.timer);
    return entry.call;
  }

  void expire(std::uint64_t number) {
    const auto call = remove(number);
    if (!call) return;
    const auto error = std::make_exception_ptr(
        TimedOut(options.peer + " did not answer " + std::string(call->operation().name) +
                 " before its deadline; whether it ran is unknown"));
    if (!call->claim()) return;
    note_end(number, call->operation(), error);
    call->finish(error);
    tell_server(number);
  }

  void abandon(std::uint64_t number) {
    const auto call = remove(number);
    if (!call) return;
    note_end(number, call->operation(), std::make_exception_ptr(Cancelled("its caller waits no longer")));
    tell_server(number);
  }

  void tell_server(std::uint64_t number) {
    std::lock_guard lock(mutex);  // once closed, `control` may be gone
    if (phase != Phase::Open) return;
    control.post([state = weak_from_this(), number] {
      const auto self = state.lock();
      if (!self) return;
      try {
        self->send_reserved(wire::kCancel, {.target = number});
      } catch (const Error&) {
        // The server will find the call expired; cancelling early is a courtesy.
      }
    });
  }

  // On the thread that takes the results: one that is held up here takes none anyway.
  void grant(std::uint64_t number, std::uint32_t count) {
    send_reserved(wire::kCredit, {.target = number, .credit = count});
  }

  // About a call; nothing is to be said to a server that is gone.
  void send_reserved(std::uint32_t operation, const wire::RequestTrailer& trailer) {
    std::shared_ptr<dds::Writer> writer;
    {
      std::lock_guard lock(mutex);
      if (phase != Phase::Open) return;
      writer = requests;
    }
    Bytes message;
    wire::begin_request(message, {client, 0}, operation);
    wire::append_default_branch(message);
    wire::append_trailer(message, trailer);
    writer->write(message);
  }

  // ---- ending

  void lose(const std::string& how) {
    {
      std::lock_guard lock(mutex);
      if (phase == Phase::Lost || phase == Phase::Closed) return;
      phase = Phase::Lost;
      lost_how = how;
      changed.notify_all();
    }
    fail_all([&](const OperationInfo& operation) {
      return std::make_exception_ptr(Disconnected(options.peer + " is gone (" + how +
                                                  "); whether " + std::string(operation.name) +
                                                  " ran is unknown"));
    });
  }

  // Nothing of the participant is in use any more when this returns.
  void close() {
    std::shared_ptr<dds::Writer> writer;
    std::shared_ptr<dds::Reader> reader;
    std::shared_ptr<void> follower;
    {
      std::lock_guard lock(mutex);
      if (phase == Phase::Closed) return;
      phase = Phase::Closed;
      writer.swap(requests);
      reader.swap(replies);
      follower.swap(companion);
      changed.notify_all();
    }
    fail_all([&](const OperationInfo& operation) {
      return std::make_exception_ptr(Cancelled("the connection to " + options.peer +
                                               " was closed during " +
                                               std::string(operation.name)));
    });
    await_senders(writer);
  }

  // A thread that is inside write() lets go of the writer soon, and none can take hold of it any more.
  static void await_senders(const std::shared_ptr<dds::Writer>& writer) {
    while (writer.use_count() > 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  template <class MakeError>
  void fail_all(MakeError make_error) {
    std::unordered_map<std::uint64_t, Entry> failed;
    {
      std::lock_guard lock(mutex);
      failed.swap(entries);
    }
    for (auto& [number, entry] : failed) {
      clock.cancel(entry.timer);
      const auto error = make_error(entry.call->operation());
      note_end(number, entry.call->operation(), error);
      entry.call->fail(error);
    }
  }
};

std::shared_ptr<DdsChannel> DdsChannel::open(dds::Participant& participant, Executor& control,
                                             std::shared_ptr<Executor> continuations,
                                             std::shared_ptr<Clock> clock,
                                             const DdsAddress& address, Options options) {
  auto state = std::make_shared<State>(participant, control, std::move(continuations),
                                       std::move(clock), address, std::move(options));
  std::shared_ptr<DdsChannel> channel(new DdsChannel(state));
  state->create_endpoints();
  state->await_open();
  return channel;
}

DdsChannel::~DdsChannel() { state_->close(); }

void DdsChannel::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  state_->start(call, in);
}

Clock& DdsChannel::clock() const noexcept { return state_->clock; }
Executor& DdsChannel::continuations() const noexcept { return *state_->continuations; }
std::string DdsChannel::peer() const { return state_->options.peer; }
void DdsChannel::disconnect() { state_->close(); }
void DdsChannel::lose(const std::string& how) { state_->lose(how); }

bool DdsChannel::connected() const {
  std::lock_guard lock(state_->mutex);
  return state_->phase == State::Phase::Open;
}

void DdsChannel::attach(std::shared_ptr<void> companion) {
  std::lock_guard lock(state_->mutex);
  state_->companion = std::move(companion);
}

std::size_t DdsChannel::pending() const {
  std::lock_guard lock(state_->mutex);
  return state_->entries.size();
}

std::uint64_t DdsChannel::malformed() const {
  std::lock_guard lock(state_->mutex);
  return state_->malformed;
}

}  // namespace skein::rpc
