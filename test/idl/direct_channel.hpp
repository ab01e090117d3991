#pragma once

#include <memory>
#include <string>

#include "skein/detail/channel.hpp"

/// A transport of the shortest kind: runs the servant on the caller's thread, in start().
class DirectChannel final : public skein::Channel {
 public:
  explicit DirectChannel(std::shared_ptr<skein::Servant> servant) : servant_(std::move(servant)) {}

  void start(const std::shared_ptr<skein::PendingCall>& call, const void* in) override {
    ++calls;
    if (!call->claim()) return;
    try {
      servant_->dispatch(call->operation(), in, call->out());
      call->finish();
    } catch (...) {
      call->finish(std::current_exception());
    }
  }
  skein::Clock& clock() const noexcept override { return clock_; }
  skein::Executor& continuations() const noexcept override { return executor_; }
  std::string peer() const override { return "the same test"; }
  bool connected() const override { return connected_; }
  void disconnect() override { connected_ = false; }
  void lose(const std::string&) override { connected_ = false; }

  int calls = 0;

 private:
  std::shared_ptr<skein::Servant> servant_;
  bool connected_ = true;
  mutable skein::ManualClock clock_;
  mutable skein::ManualExecutor executor_;
};
