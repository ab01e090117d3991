#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "rpc/client/caller_answers.hpp"
#include "rpc/client/remote_channel.hpp"
#include "rpc/wire/shared_use.hpp"
#include "rpc/wire/wire.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/stream.hpp"

namespace skein::rpc {

/// Opening and ending stand in remote_channel.cpp, calls in remote_channel_calls.cpp, what comes
/// back in remote_channel_replies.cpp.
struct RemoteChannel::State : std::enable_shared_from_this<State> {
  enum class Keep { Nothing, Streams };
  struct Entered {
    std::uint64_t number = 0;
    std::shared_ptr<calls::Sender> sender;
  };
  enum class Phase { Opening, Open, Lost, Closed };

  using Entries = std::pmr::unordered_map<std::uint64_t, std::shared_ptr<PendingCall>>;

  State(calls::ClientPort& port_, Executor& control_, std::shared_ptr<Executor> continuations_,
        std::shared_ptr<Clock> clock_, calls::Address address_, Options options_)
      : port(port_),
        control(control_),
        continuations(std::move(continuations_)),
        owned_clock(std::move(clock_)),
        clock(*owned_clock),
        address(std::move(address_)),
        options(std::move(options_)) {}

  calls::ClientPort& port;
  Executor& control;
  const std::shared_ptr<Executor> continuations;
  const std::shared_ptr<Clock> owned_clock;
  Clock& clock;
  const calls::Address address;
  const Options options;

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::atomic<Phase> phase{Phase::Opening};  // changed under the lock
  std::string lost_how;
  std::atomic<bool> retiring{false};       // the session ends with the last call on its way
  std::shared_ptr<RemoteChannel> channel;  // itself, as long as it retires
  std::exception_ptr refusal;
  std::vector<Guid> servers;  // their request receivers
  std::uint64_t last_number = 0;
  std::uint64_t malformed = 0;
  std::uint64_t forged = 0;
  std::string first_malformed;  // what was wrong with it
  Entries entries{&call_memory()};
  std::atomic<std::uint64_t> told{0};  // how often the server was told that a call has ended
  TimerId timer = 0;                   // one for all calls: steady calls come and go without it
  Instant timer_due = Instant::max();
  Guid client;
  SharedUse senders;
  std::shared_ptr<calls::Sender> requests;
  std::shared_ptr<calls::Receiver> replies;
  std::shared_ptr<CallerAnswers> answers;  // of `replies`; null where callers cannot take them
  std::shared_ptr<void> companion;

  // ---- opening
  void create_endpoints();
  void await_open();
  void send_open();

  // ---- on the port's threads
  void on_server(const Guid& receiver, bool found);
  void on_message(const calls::Message& message);
  bool is_provider(const Guid& sender) const;
  void note_forged(const Guid& sender);
  void on_unreadable(std::span<const std::byte> message, const std::exception& why);
  void on_reply(std::span<const std::byte> message, const wire::ReplyHead& head);
  void note_malformed(const std::string& why);
  std::string what_came_malformed() const;
  void on_opened(std::span<const std::byte> message, const wire::ReplyHead& head);
  void dismissed(const std::string& how);
  void complete(PendingCall& call, std::span<const std::byte> message, const wire::ReplyHead& head);
  std::exception_ptr unreadable(const OperationInfo& operation, const std::exception& malformed);
  void on_stream_reply(std::uint64_t number, PendingStream& stream,
                       std::span<const std::byte> message, const wire::ReplyHead& head);
  void read_part(std::uint64_t number, PendingStream& stream, std::span<const std::byte> message,
                 const wire::ReplyHead& head);
  void note_end(std::uint64_t number, const OperationInfo& operation,
                const std::exception_ptr& error);

  // ---- calls
  void start(const std::shared_ptr<PendingCall>& call, const void* in);
  void start_here(const std::shared_ptr<PendingCall>& call, const void* in);
  void call(const OperationInfo& operation, const void* in, void* out, const CallTime& time);
  Entered enter(const std::shared_ptr<PendingCall>& call);
  void on_full();
  TimerId look_at(Instant deadline);
  void expire_due();
  bool send(calls::Sender& sender, const PendingCall& call, std::uint64_t number, const void* in);
  void put_request(Bytes& message, const PendingCall& call, std::uint64_t number,
                   const void* in) const;
  template <class Send>
  auto in_time(const PendingCall& call, Send send) const;
  bool is_open() const;
  std::shared_ptr<PendingCall> remove(std::uint64_t number, Keep keep = Keep::Nothing);
  void expire(std::uint64_t number);
  void abandon(std::uint64_t number);
  void tell_server(std::uint64_t number);
  void grant(std::uint64_t number, std::uint32_t count);
  void send_reserved(std::uint32_t operation, const wire::RequestTrailer& trailer);

  // ---- ending
  void lose(const std::string& how);
  void retire(const std::string& how, std::shared_ptr<RemoteChannel> itself);
  void part_later();
  void part();
  void close();
  template <class MakeError>
  void fail_all(MakeError make_error);
};

}  // namespace skein::rpc
