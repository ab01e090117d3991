#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "call_port/call_port.hpp"
#include "skein/detail/channel.hpp"

namespace skein::rpc {

/// Lets the thread that waits for a call take its answer from the connection's receiver, if nobody
/// else waits for what comes there. Thread-safe.
class CallerAnswers final : public Answers {
 public:
  explicit CallerAnswers(std::shared_ptr<calls::CallerDelivery> delivery)
      : delivery_(std::move(delivery)) {}

  /// The port's thread takes what comes until somebody waits again.
  void hand_over() { delivery_->take_back(); }

  void begin(bool blocking) override {
    if (calls_++ == 0 && blocking) expect();
  }
  void end() override {
    if (--calls_ == 0) delivery_->take_back();
  }
  void take_until(const std::atomic<bool>& finished) override {
    if (attended_ != 0 || taken_.exchange(true)) return;
    expect();
    delivery_->deliver_until([&finished] { return finished.load(); });
    taken_ = false;
    // A thread with more calls under way usually waits for the next answer soon.
    calls_ == 0 ? delivery_->take_back() : delivery_->pause();
  }
  void wake() override { delivery_->wake(); }
  void attend() override {
    ++attended_;
    delivery_->take_back();
  }
  void leave() override { --attended_; }

 private:
  // The port's thread need not wake up for what comes, until all calls have ended. Sequentially
  // consistent with attend(): either this sees that a call is attended, or that one takes back.
  void expect() {
    if (attended_ != 0) return;
    delivery_->lend();
    if (attended_ != 0) delivery_->take_back();
  }

  const std::shared_ptr<calls::CallerDelivery> delivery_;
  std::atomic<int> calls_{0};
  std::atomic<int> attended_{0};
  std::atomic<bool> taken_{false};  // by a thread that waits
};

}  // namespace skein::rpc
