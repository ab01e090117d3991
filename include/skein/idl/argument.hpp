#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

namespace skein {

/// An `in` or `inout` parameter on its way: a value of its own, or one borrowed from the caller,
/// who keeps it alive while the request is handed over. So a proxy hands over a mebibyte without
/// copying it. A copy always owns its value.
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

  /// The value as one that belongs to this object; what was borrowed is forgotten, not copied.
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
