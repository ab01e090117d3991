#pragma once

#include <chrono>
#include <memory>
#include <mutex>

#include "description_reader.hpp"
#include "description_writer.hpp"

namespace skein::brokerless_discovery {

/// Asks for descriptions again, and writes this peer's again, when that is due. It looks four times
/// a lease, on `control`, one look at a time.
class Beat {
 public:
  /// Nothing happens any more once `owner` has gone.
  Beat(Clock& clock, Executor& control, std::chrono::milliseconds lease, LockedTable& table,
       DescriptionReader& reader, DescriptionWriter& writer, const std::weak_ptr<void>& owner)
      : clock_(clock),
        control_(control),
        lease_(lease),
        table_(table),
        reader_(reader),
        writer_(writer),
        owner_(owner) {}

  /// Call it after the reader was opened: to make that the first time may take long, and is no
  /// sleep.
  void start() {
    last_ = clock_.now();
    arm();
  }
  void stop() {
    TimerId timer;
    {
      std::lock_guard lock(mutex_);
      stopped_ = true;
      timer = timer_;
    }
    clock_.cancel(timer);
  }

 private:
  void arm() {
    std::lock_guard lock(mutex_);
    if (stopped_) return;
    timer_ = clock_.call_after(lease_ / 4, [this, owner = owner_] {
      const auto kept = owner.lock();
      if (!kept) return;
      // No look may be lost: each sets the timer of the next.
      control_.post_or_run([this, owner] {
        if (const auto kept = owner.lock()) look();
      });
    });
  }

  // R17: a peer that slept through its lease is suspect to others, and on some vendors stays so
  // until it writes again.
  void look() {
    reader_.renew_if_due();
    const Instant now = clock_.now();
    const bool slept = now - last_ > lease_ / 2;
    writer_.write_again(slept, table_.take_contradicted());
    last_ = now;
    arm();
  }

  Clock& clock_;
  Executor& control_;
  const std::chrono::milliseconds lease_;
  LockedTable& table_;
  DescriptionReader& reader_;
  DescriptionWriter& writer_;
  const std::weak_ptr<void>& owner_;
  Instant last_{};
  std::mutex mutex_;
  bool stopped_ = false;
  TimerId timer_ = 0;
};

}  // namespace skein::brokerless_discovery
