#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "skein/detail/loan_memory.hpp"

/// A parameter that both sides of a call can read where it lies is left out of the message.
namespace skein::idl {

/// While it exists, the first parameter that this thread encodes and that is the content of
/// LoanMemory is left out. One at a time for each thread.
class LeavingOut {
 public:
  LeavingOut() { current_ = this; }
  ~LeavingOut() { current_ = nullptr; }
  LeavingOut(const LeavingOut&) = delete;
  LeavingOut& operator=(const LeavingOut&) = delete;

  /// Whether the value is left out at `position` of the message.
  bool take(const void* value, std::size_t size, std::size_t position);
  /// The message is begun again.
  void forget() { memory_ = nullptr; }

  /// Where it lies; null if nothing was left out.
  const std::shared_ptr<LoanMemory>& memory() const noexcept { return memory_; }
  std::size_t position() const noexcept { return position_; }

  /// This thread's, or null.
  static LeavingOut* current() noexcept { return current_; }

 private:
  static thread_local LeavingOut* current_;
  std::shared_ptr<LoanMemory> memory_;
  std::size_t position_ = 0;
};

/// While it exists, what this thread decodes has at `position` a value that its message left out.
/// It is borrowed, not copied. One at a time for each thread.
class PuttingIn {
 public:
  PuttingIn(std::span<const std::byte> value, std::size_t position)
      : value_(value), position_(position) {
    current_ = this;
  }
  ~PuttingIn() { current_ = nullptr; }
  PuttingIn(const PuttingIn&) = delete;
  PuttingIn& operator=(const PuttingIn&) = delete;

  /// Nothing if none is missing there.
  std::optional<std::span<const std::byte>> take(std::size_t position);
  /// Whether it has been taken.
  bool taken() const noexcept { return taken_; }

  static PuttingIn* current() noexcept { return current_; }

 private:
  static thread_local PuttingIn* current_;
  const std::span<const std::byte> value_;
  const std::size_t position_;
  bool taken_ = false;
};

}  // namespace skein::idl
