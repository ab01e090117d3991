#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "rpc/service/call_journal.hpp"
#include "rpc/service/invocation.hpp"
#include "skein/clock.hpp"
#include "skein/detail/channel.hpp"
#include "skein/error.hpp"

namespace skein::rpc {

/// An invocation that knows its caller.
struct QueuedCall final : Invocation {
  QueuedCall(std::shared_ptr<PendingCall> call_, std::shared_ptr<Clock> clock_,
             std::shared_ptr<CallJournal> journal_, std::string_view service_)
      : call(std::move(call_)),
        clock(std::move(clock_)),
        journal(std::move(journal_)),
        service(service_) {}

  void end(const void* out, std::exception_ptr error);

  /// Ends it for the caller, and tells the implementation.
  void give_up(std::exception_ptr error) {
    if (!call->claim()) return;
    cancel();
    note_end(error);
    call->finish(std::move(error));
  }

  /// Its caller has ended it.
  void abandon() {
    cancel();
    note_end(std::make_exception_ptr(Cancelled("its caller waits no longer")));
  }

  void note_end(const std::exception_ptr& error) const {
    if (journal) journal->note_end(false, connection, number, service, call->operation(), error);
  }

  bool served_as_called() const { return operation == &call->operation(); }

  const std::shared_ptr<PendingCall> call;
  const std::shared_ptr<Clock> clock;
  const std::shared_ptr<CallJournal> journal;
  const std::string_view service;
  std::atomic<TimerId> timer{0};
};

/// The calls of a connection within the process that have not ended, until it is closed.
/// Thread-safe.
class QueuedCalls {
 public:
  bool closed() const noexcept { return closed_; }
  /// False once closed.
  bool add(const std::shared_ptr<QueuedCall>& call);
  std::size_t size() const;
  /// Takes no more. Returns those that have not ended.
  std::vector<std::shared_ptr<QueuedCall>> close();

 private:
  std::atomic<bool> closed_{false};
  mutable std::mutex mutex_;
  std::vector<std::weak_ptr<QueuedCall>> calls_;  // and what has ended since the last look
  std::size_t look_at_ = 16;
};

}  // namespace skein::rpc
