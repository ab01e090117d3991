#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "rpc/service/call_journal.hpp"
#include "rpc/service/call_recorder.hpp"
#include "rpc/service/caller_turns.hpp"
#include "rpc/service/fair_queue.hpp"
#include "rpc/service/outgoing_stream.hpp"
#include "rpc/service/service_meter.hpp"
#include "skein/call_context.hpp"
#include "skein/clock.hpp"
#include "skein/detail/action.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/detail/channel.hpp"
#include "skein/detail/operation.hpp"
#include "skein/error.hpp"
#include "skein/executor.hpp"
#include "skein/guid.hpp"

namespace skein::introspection {
struct ServiceStatistics;
}

namespace skein::rpc {

/// What a client asks for when it connects: the paper's `initialize()`.
struct OpenRequest {
  Guid client;           ///< Nil for a client in the same process.
  std::string strategy;  ///< Selection strategy by name; empty means the provider's default.
};

/// Makes a Head's session for a new client; throws Error to refuse it.
using SessionFactory = std::function<std::shared_ptr<Session>(const OpenRequest&)>;

/// One request as the provider sees it, from whichever transport. It owns its arguments.
struct Invocation {
  const OperationInfo* operation = nullptr;
  /// Keeps what parameters refer to where they were not copied.
  std::shared_ptr<const void> lent;
  /// The in struct; freed by the operation's own TypeSupport.
  std::unique_ptr<void, void (*)(void*)> in{nullptr, [](void*) {}};
  Guid caller;
  Guid connection;           ///< With whose other invocations it waits in line.
  std::uint64_t number = 0;  ///< The connection's own count.
  Instant arrived;
  Instant begun;  ///< When the implementation was called.
  Instant ended;  ///< When the implementation had returned or thrown.
  Instant deadline;
  std::vector<Guid> chain;  ///< Who waits for the answer, as the request says.
  /// The call on whose thread, and for which, this one runs; null where it has a thread of its own.
  const CallContext* outer = nullptr;
  std::shared_ptr<Session> session;
  std::atomic<bool> cancelled{false};
  /// Where the results go, where the operation is a stream.
  std::shared_ptr<OutgoingStream> stream;
  /// Called once, on the thread that executes it: the out struct, or what was thrown; neither at
  /// the end of a stream.
  std::function<void(const void* out, std::exception_ptr error)> respond;
  std::shared_ptr<Invocation> next;  ///< The FairQueue's.

  /// Nobody waits for the answer any more: the implementation hears so (CallContext, StreamSink,
  /// Reply). Not under a lock.
  void cancel() {
    stop(ErrorCode::Cancelled, "its caller waits no longer");
    tell_cancelled();
  }
  /// Without the action of on_cancel().
  void stop(ErrorCode code, const std::string& why) {
    cancelled = true;
    if (stream) stream->stop(code, why);
  }

  /// Runs `action` when the call is cancelled; at once if it already is. An empty one forgets it.
  void on_cancel(Action action);
  void tell_cancelled();

 private:
  std::mutex action_mutex_;
  Action action_;
};

/// A provided service, whatever transport its calls come by: the implementation and the threads
/// that run it. Expired and cancelled invocations are dropped unexecuted. An implementation may owe
/// as many answers as invocations may wait, and a peer its share of them (see FairQueue).
class Service : public std::enable_shared_from_this<Service> {
 public:
  struct Options {
    /// Identity of this provider of this service; also its partition.
    Guid id = Guid::random();
    /// Identity of the threads: services that share one executor share it. Nil: the service's own.
    Guid strand;
    /// How many calls the executor runs at once: a call is refused that would wait for itself, as
    /// all these threads are blocked in calls that led to it.
    std::size_t threads = 1;
    /// Invocations that may wait in all; see FairQueue.
    std::size_t queue = 2048;
    /// What people call a strand, for messages; empty: its number.
    std::function<std::string(const Guid& strand)> name_of;
    /// With CallThread::Caller calls run one at a time, and `threads` is 1.
    CallThread thread = CallThread::Own;
    SessionFactory open;
    std::shared_ptr<CallJournal> journal;    ///< May be null.
    std::shared_ptr<CallRecorder> recorder;  ///< May be null.
    /// What lives as long as the service: its executor, say.
    std::shared_ptr<const void> keeps;
  };

  /// `executor` and `clock` outlive the service.
  Service(std::shared_ptr<Servant> servant, Executor& executor, Clock& clock, Options options);
  ~Service();

  const InterfaceInfo& interface_info() const noexcept { return servant_->interface_info(); }
  const Guid& id() const noexcept { return options_.id; }
  const Guid& strand() const noexcept { return options_.strand; }
  const Clock& clock() const noexcept { return clock_; }
  /// Where blocking calls from the same process run.
  CallThread thread() const noexcept { return options_.thread; }

  /// Whether it is about to leave, or has left, also after it is gone: new calls go elsewhere.
  std::shared_ptr<const std::atomic<bool>> leaving() const noexcept { return leaving_; }

  /// A session for a new client (nullptr where the service has no Head). Throws Unavailable once
  /// the service is closed.
  std::shared_ptr<Session> open(const OpenRequest& request) const;

  /// Queues the invocation; its respond() tells the outcome. Throws Overloaded where its connection
  /// has no room left in the queue, and Unavailable where the call chain shows that it would wait
  /// for itself; respond() is not called then. On the service's own thread (Reception) a call runs
  /// at once, and has ended when it returns, if it is neither a stream nor answered later, none
  /// waits before it, and `may_run` agrees, which is asked right before it.
  void submit(const std::shared_ptr<Invocation>& invocation,
              const std::function<bool()>& may_run = {});

  /// Whether a stream has been submitted since this was asked before.
  bool forget_stream() noexcept { return stream_submitted_ && stream_submitted_.exchange(false); }

  /// With CallThread::Caller: runs the operation on the calling thread, once those before it have
  /// ended. The outcome is in `out` or thrown: TimedOut, too, where its turn or its end came too
  /// late, and Unavailable as by submit().
  void call_here(const OperationInfo& operation, const void* in, void* out, Invocation& frame);

  /// Throws Unavailable, which names the services of the circle, where the invocation would wait
  /// for itself.
  void refuse_self_wait(const Invocation& invocation) const;

  /// Whether an invocation is still inside the implementation although its deadline has passed.
  bool overdue() const;

  /// Whether as many are, as it has threads: it makes no progress.
  bool is_stuck() const;

  /// What it has done and does; entity and system are left empty.
  introspection::ServiceStatistics statistics() const;

  /// The service is about to end: no new session is opened, and whoever asks leaving() calls
  /// elsewhere. What comes all the same is executed.
  void leave();

  /// After leave(): waits until no invocation waits, runs or is owed an answer, and refuses those
  /// that come later; false, and refuses none, at the deadline.
  bool finish(Instant deadline);

  /// Invocations that have not begun are refused, now and from now on; those that run are told to
  /// stop, and those that are owed an answer end as Disconnected. When it returns, Options::open
  /// and name_of are not running and will not run: whoever they ask may go.
  void close();

  /// Once closed: waits until no invocation is inside the implementation; false at the deadline.
  bool await_end(std::chrono::steady_clock::time_point deadline) const;

 private:
  class Deferred;
  class Running;
  std::size_t count_overdue() const;
  void enqueue(std::shared_ptr<Invocation> invocation);
  void execute_next();
  std::shared_ptr<Invocation> take_next();
  void withdraw(Invocation& invocation);
  void note_begin(const OperationInfo& operation, const Invocation& frame);
  void note_end(const OperationInfo& operation, const Invocation& frame,
                const std::exception_ptr& error);
  void answer(Invocation& invocation, const void* out, std::exception_ptr error);
  void execute(const std::shared_ptr<Invocation>& invocation);
  void execute_in_turn(const std::shared_ptr<Invocation>& invocation, bool turn_came, Instant now);
  void execute_now(Invocation& invocation);
  void execute_deferred(const std::shared_ptr<Invocation>& invocation);
  bool is_deferred(const OperationInfo& operation) const noexcept;
  bool runs_on_arrival(const OperationInfo& operation) const;
  bool may_owe(const Guid& connection) const;
  bool owe(Deferred& deferred, const Guid& connection);
  void settle(Deferred& deferred, const Guid& connection);
  void end(Deferred& deferred, std::exception_ptr error);
  std::string circle(const std::vector<Guid>& chain) const;
  void refuse_too_late(const OperationInfo& operation, const Invocation& frame) const;
  void stop(Invocation& invocation) const;
  NotSent being_withdrawn() const;
  bool is_idle() const noexcept { return accepted_ == 0 && !running_ && deferred_.empty(); }
  void note_done();
  bool others_wait() const;
  void begin_here(OperationMeter& meter, const Invocation& frame) const;
  [[noreturn]] void refuse_turn(OperationMeter& meter, const OperationInfo& operation) const;
  void dispatch(const OperationInfo& operation, const void* in, void* out, Invocation& frame);
  template <class Action>
  void enter(const OperationInfo& operation, Invocation& frame, Action action);
  template <class Action>
  void account(const OperationInfo& operation, const void* out, Invocation& frame,
               CallRecorder::Tap& tap, Action action);

  std::shared_ptr<Servant> servant_;
  Executor& executor_;
  Clock& clock_;
  Options options_;
  std::atomic<bool> closed_{false};
  const std::shared_ptr<std::atomic<bool>> leaving_ = std::make_shared<std::atomic<bool>>(false);
  /// That wait in the queue, are on a thread, or are just being answered.
  std::atomic<std::size_t> accepted_{0};
  mutable std::mutex owner_mutex_;  // held while `open` or `name_of` runs
  ServiceMeter meter_;
  mutable std::mutex queue_mutex_;
  FairQueue queue_;
  const std::unique_ptr<CallerTurns> caller_turns_;  // with CallThread::Caller
  std::atomic<bool> latest_was_long_{false};         // of those that are no streams
  std::atomic<bool> stream_submitted_{false};
  mutable std::mutex mutex_;
  mutable std::condition_variable less_to_do_;  // once it is leaving
  Running* running_ = nullptr;  // the first of a list that lies on the stacks of those who run
  std::pmr::unordered_set<Deferred*> deferred_{&call_memory()};
  std::pmr::unordered_map<Guid, std::size_t> owed_{&call_memory()};  // by peer, none is 0
};

}  // namespace skein::rpc
