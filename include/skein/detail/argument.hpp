#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "skein/detail/box.hpp"

namespace skein {

/// An `in` or `inout` parameter of a request. It owns its value, or borrows the caller's, which
/// must live until the request has been sent: so a proxy passes a mebibyte on without copying it. A
/// copy always owns its value.
template <class T>
class Argument {
 public:
  Argument() = default;
  template <class U>
  requires std::convertible_to<U, T> &&
      (!std::same_as<std::remove_cvref_t<U>, Argument>)Argument(U&& value)
      : own_(std::forward<U>(value)) {}
  Argument(const Argument& other) : own_(other.get()) {}
  Argument(Argument&&) noexcept = default;
  Argument& operator=(const Argument& other) {
    if (this != &other) own() = other.get();
    return *this;
  }
  Argument& operator=(Argument&&) noexcept = default;

  /// Refers to `value` without copying it.
  static Argument borrow(const T& value) {
    Argument argument;
    argument.borrowed_ = &value;
    return argument;
  }

  const T& get() const noexcept {
    if (borrowed_) return *borrowed_;
    if constexpr (kBoxed) {
      return *own_;
    } else {
      return own_;
    }
  }
  operator const T&() const noexcept { return get(); }
  const T& operator*() const noexcept { return get(); }
  const T* operator->() const noexcept { return &get(); }

  /// The owned value. A borrowed value is forgotten, not copied.
  T& own() {
    borrowed_ = nullptr;
    if constexpr (kBoxed) {
      return *own_;
    } else {
      return own_;
    }
  }

  friend bool operator==(const Argument& left, const Argument& right) {
    return left.get() == right.get();
  }

 private:
  /// A request lies on its caller's stack.
  static constexpr bool kBoxed = sizeof(T) > std::size_t{4096};

  std::conditional_t<kBoxed, Box<T>, T> own_{};
  const T* borrowed_ = nullptr;
};

}  // namespace skein
