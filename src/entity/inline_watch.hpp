#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "skein/core/clock.hpp"
#include "skein/core/executor.hpp"
#include "skein/core/worker.hpp"

namespace skein::entity {

/// The CSPs that run on the threads of those who asked for them. One that is not back by its
/// deadline costs its thread: the worker is written off, and `lost` is run in its place. A timer
/// stands for the earliest deadline only, so that a steady stream of calls sets hardly any.
/// Thread-safe.
class InlineWatch : public std::enable_shared_from_this<InlineWatch> {
 public:
  /// Both outlive the watch's use, up to close().
  InlineWatch(Clock& clock, Executor& control) : clock_(clock), control_(control) {}

  /// The work that is done on the calling thread while this lives. If it is written off, what made
  /// this does not run on: see Worker.
  class Watched {
   public:
    /// `lost` runs on `control`, instead of the rest of the calling thread. At most `most` CSPs may
    /// run so, those that never came back among them: beyond that the work is not admitted.
    Watched(InlineWatch& watch, Worker& worker, Instant deadline, std::size_t most,
            const std::function<void()>& lost);
    ~Watched();
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;
    bool admitted() const noexcept { return admitted_; }

   private:
    friend class InlineWatch;
    InlineWatch& watch_;
    Worker& worker_;
    const Instant deadline_;
    const std::function<void()>& lost_;
    bool admitted_ = false;
  };

  /// Workers that were written off.
  std::size_t lost() const noexcept { return lost_; }

  /// No `lost` runs any more when this has returned. Not from one of them.
  void close();

 private:
  bool admit(Watched& work, std::size_t most);
  void dismiss(Watched& work);
  void arm(Instant when);
  void expire(Instant timer);
  std::vector<Watched*> take_overdue(Instant timer);

  Clock& clock_;
  Executor& control_;
  std::atomic<std::size_t> lost_{0};
  std::mutex mutex_;
  std::vector<Watched*> works_;
  std::map<Instant, TimerId> timers_;  // each was the earliest when it was set
  std::mutex expiring_;                // taken before `mutex_`
  bool closed_ = false;                // under `expiring_`
};

}  // namespace skein::entity
