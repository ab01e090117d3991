#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "dds/port/port.hpp"
#include "skein/detail/channel.hpp"

namespace skein::rpc {

/// Lets the thread that waits for a call take its answer from the connection's reader, where nobody
/// else waits for what comes there. Thread-safe.
class CallerAnswers final : public Answers {
 public:
  explicit CallerAnswers(std::shared_ptr<dds::CallerDelivery> delivery)
      : delivery_(std::move(delivery)) {}

  /// The answer to what is sent next is waited for at once: the reader's thread need not wake up.
  void expect() {
    if (attended_ == 0) delivery_->lend();
  }
  /// The reader's thread takes what comes until somebody waits again.
  void hand_over() { delivery_->take_back(); }

  void take_until(const std::atomic<bool>& finished) override {
    if (attended_ != 0 || taken_.exchange(true)) return;
    delivery_->lend();
    if (attended_ != 0) delivery_->take_back();
    delivery_->deliver_until([&finished] { return finished.load(); });
    taken_ = false;
  }
  void wake() override { delivery_->wake(); }
  void attend() override {
    ++attended_;
    delivery_->take_back();
  }
  void leave() override { --attended_; }

 private:
  const std::shared_ptr<dds::CallerDelivery> delivery_;
  std::atomic<int> attended_{0};
  std::atomic<bool> taken_{false};  // by a thread that waits
};

}  // namespace skein::rpc
