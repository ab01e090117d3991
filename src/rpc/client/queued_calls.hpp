#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "core/weak_list.hpp"
#include "rpc/service/call_journal.hpp"
#include "rpc/service/invocation.hpp"
#include "rpc/wire/conversion.hpp"
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

  static bool is_over(const std::weak_ptr<QueuedCall>& weak) {
    const auto queued = weak.lock();
    return !queued || queued->call->finished();
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
  WeakList<QueuedCall> calls_;
};

inline void QueuedCall::end(const void* out, std::exception_ptr error) {
  clock->cancel(timer);
  if (!call->claim()) return;
  try {
    if (!error && out) convert(*operation->out, out, *call->operation().out, call->out());
    if (!served_as_called()) error = convert(error, call->operation());
  } catch (...) {
    error = std::current_exception();
  }
  note_end(error);
  call->finish(std::move(error));
}

inline bool QueuedCalls::add(const std::shared_ptr<QueuedCall>& call) {
  std::lock_guard lock(mutex_);
  if (closed_) return false;
  calls_.push(call, QueuedCall::is_over);
  return true;
}

inline std::size_t QueuedCalls::size() const {
  std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(
      std::ranges::count_if(calls_.all(), std::not_fn(QueuedCall::is_over)));
}

inline std::vector<std::shared_ptr<QueuedCall>> QueuedCalls::close() {
  WeakList<QueuedCall>::List taken;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    taken = calls_.take_all();
  }
  std::vector<std::shared_ptr<QueuedCall>> open;
  for (const auto& weak : taken) {
    if (auto call = weak.lock()) open.push_back(std::move(call));
  }
  return open;
}

}  // namespace skein::rpc
