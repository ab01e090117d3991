#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "rpc/service/call_accounts.hpp"
#include "rpc/service/call_execution.hpp"
#include "rpc/service/call_intake.hpp"
#include "rpc/service/caller_turns.hpp"
#include "rpc/service/circular_wait.hpp"
#include "rpc/service/owed_answers.hpp"
#include "rpc/service/service_owner.hpp"
#include "rpc/service/unfinished_calls.hpp"
#include "skein/clock.hpp"
#include "skein/detail/operation.hpp"
#include "skein/executor.hpp"
#include "skein/guid.hpp"

namespace skein::introspection {
struct ServiceStatistics;
}

namespace skein::rpc {

/// A provided service, whatever transport its calls come by: the implementation and the threads
/// that run it. Expired and cancelled invocations are dropped unexecuted. Its locks are in its
/// parts; if one is taken under another, the order is UnfinishedCalls, a stream, CallIntake,
/// OwedAnswers. ServiceOwner's and CallerTurns' are taken with no other held.
///
/// Which thread runs a call: the caller's, if it waits in this process and the service has
/// CallThread::Caller (LocalChannel::call() decides, and uses call_here()); the service's own
/// thread if that has just taken the message (submit()); else the executor's next. Which thread
/// takes a message: for shared memory same_host/receiver.hpp decides; for DDS it is the vendor's.
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
    ServiceOwner::NameOf name_of;
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
  /// Where blocking calls from the same process run.
  CallThread thread() const noexcept { return options_.thread; }

  /// Whether it is about to leave, or has left, also after it is gone: new calls go elsewhere.
  std::shared_ptr<const std::atomic<bool>> leaving() const noexcept { return leaving_; }

  /// A session for a new client (nullptr where the service has no Head). Throws NotSent once the
  /// service is about to leave.
  std::shared_ptr<Session> open(const OpenRequest& request) const {
    return owner_.open(request, interface_info().name);
  }

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

  /// How many invocations are inside the implementation although their deadline has passed.
  std::size_t overdue() const;

  /// Whether as many are, as it has threads: it makes no progress.
  bool is_stuck() const { return overdue() >= options_.threads; }

  /// What it has done and does; entity and system are left empty.
  introspection::ServiceStatistics statistics() const;

  /// The service is about to end: no new session is opened, and whoever asks leaving() calls
  /// elsewhere. What comes all the same is executed.
  void leave() { *leaving_ = true; }

  /// After leave(): waits until no invocation waits, runs or is owed an answer, and refuses those
  /// that come later; false, and refuses none, at the deadline.
  bool finish(Instant deadline) { return calls_.finish(clock_, deadline, owed_); }

  /// Invocations that have not begun are refused, now and from now on; those that run are told to
  /// stop, and those that are owed an answer end as Disconnected. When it returns, Options::open
  /// and name_of are not running and will not run: whoever they ask may go.
  void close();

  /// Once closed: waits until no invocation is inside the implementation; false at the deadline.
  bool await_end(std::chrono::steady_clock::time_point deadline) const {
    return calls_.await_end(deadline);
  }

 private:
  std::shared_ptr<Servant> servant_;
  Executor& executor_;
  Clock& clock_;
  const Options options_;
  const std::shared_ptr<std::atomic<bool>> leaving_ = std::make_shared<std::atomic<bool>>(false);
  const CircularWait circular_wait_;
  ServiceOwner owner_;
  CallAccounts accounts_;
  UnfinishedCalls calls_;
  OwedAnswers owed_;
  CallIntake intake_;
  const std::unique_ptr<CallerTurns> caller_turns_;  // with CallThread::Caller
  CallExecution execution_;
  std::atomic<bool> stream_submitted_{false};
};

}  // namespace skein::rpc
