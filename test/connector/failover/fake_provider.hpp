#pragma once

#include <atomic>
#include <deque>
#include <functional>

#include "skein/detail/channel.hpp"
#include "skein/error.hpp"

namespace skein::test {

/// An operation from a number to a number.
inline const TypeSupport& number_type() {
  static const TypeSupport type{
      "Number",
      Representation::Xcdr1,
      [](const TypeSupport&) { return static_cast<void*>(new int{}); },
      [](void* value) noexcept { delete static_cast<int*>(value); },
      [](void* to, const void* from) { *static_cast<int*>(to) = *static_cast<const int*>(from); },
      nullptr,
      nullptr,
      nullptr,
      nullptr};
  return type;
}

inline OperationInfo number_operation(bool idempotent) {
  OperationInfo operation{};
  operation.name = "count";
  operation.idempotent = idempotent;
  operation.in = operation.out = &number_type();
  return operation;
}

/// A connection whose calls wait until the test, or the connection's own end, ends them.
struct FakeChannel final : Channel {
  FakeChannel(Clock& own_clock, Executor& executor) : clock_(own_clock), continuations_(executor) {}
  ~FakeChannel() override {
    for (const auto& call : calls)
      call->fail(std::make_exception_ptr(Cancelled("the connection was closed")));
  }

  void start(const std::shared_ptr<PendingCall>& call, const void* in) override {
    calls.push_back(call);
    call->set_canceller([this] { ++cancelled; });
    arguments.push_back(*static_cast<const int*>(in));
    if (while_it_starts) while_it_starts();
    if (refuses) call->fail(std::make_exception_ptr(Overloaded("full")));
  }
  Clock& clock() const noexcept override { return clock_; }
  Executor& continuations() const noexcept override { return continuations_; }
  std::string peer() const override { return "fake"; }
  bool connected() const override { return stands; }
  void disconnect() override { stands = false; }

  void answer(std::size_t index, int result) {
    if (!calls.at(index)->claim()) return;
    *static_cast<int*>(calls[index]->out()) = result;
    calls[index]->finish();
  }
  void lose(const std::string& = "gone") override {
    stands = false;
    for (const auto& call : calls) call->fail(std::make_exception_ptr(Disconnected("gone")));
  }

  /// Ends, and refuses what it has not begun.
  void withdraw() {
    stands = false;
    for (const auto& call : calls)
      call->fail(std::make_exception_ptr(Unavailable("it is being withdrawn")));
  }

  Clock& clock_;
  Executor& continuations_;
  std::deque<std::shared_ptr<PendingCall>> calls;
  std::deque<int> arguments;
  bool stands = true;
  bool refuses = false;
  int cancelled = 0;
  std::function<void()> while_it_starts;
  std::shared_ptr<std::atomic<bool>> suspect = std::make_shared<std::atomic<bool>>(false);
};

}  // namespace skein::test
