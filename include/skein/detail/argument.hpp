#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

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

  const T& get() const noexcept { return borrowed_ ? *borrowed_ : own_; }
  operator const T&() const noexcept { return get(); }
  const T& operator*() const noexcept { return get(); }
  const T* operator->() const noexcept { return &get(); }

  /// The owned value. A borrowed value is forgotten, not copied.
  T& own() noexcept {
    borrowed_ = nullptr;
    return own_;
  }

  friend bool operator==(const Argument& left, const Argument& right) {
    return left.get() == right.get();
  }

 private:
  T own_{};
  const T* borrowed_ = nullptr;
};

}  // namespace skein
