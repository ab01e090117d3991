#pragma once

#include <concepts>
#include <utility>
#include <variant>

namespace skein {

/// An `in` or `inout` parameter on its way: a value of its own, or one borrowed from the caller, who
/// keeps it alive while the request is handed over. So a proxy hands over a mebibyte without copying
/// it. A copy always owns its value.
template <class T>
class Argument {
 public:
  Argument() = default;
  template <class U>
    requires std::convertible_to<U, T> && (!std::same_as<std::remove_cvref_t<U>, Argument>)
  Argument(U&& value) : held_(std::in_place_index<0>, std::forward<U>(value)) {}
  Argument(const Argument& other) : held_(std::in_place_index<0>, other.get()) {}
  Argument(Argument&&) noexcept = default;
  Argument& operator=(const Argument& other) {
    if (this != &other) own() = other.get();
    return *this;
  }
  Argument& operator=(Argument&&) noexcept = default;

  /// Refers to `value` without copying it.
  static Argument borrow(const T& value) {
    Argument argument(Borrowed{});
    argument.held_.template emplace<1>(&value);
    return argument;
  }

  const T& get() const noexcept {
    const T* const* borrowed = std::get_if<1>(&held_);
    return borrowed ? **borrowed : *std::get_if<0>(&held_);
  }
  operator const T&() const noexcept { return get(); }
  const T& operator*() const noexcept { return get(); }
  const T* operator->() const noexcept { return &get(); }

  /// The value as one that belongs to this object; what was borrowed is forgotten, not copied.
  T& own() {
    if (T* owned = std::get_if<0>(&held_)) return *owned;
    return held_.template emplace<0>();
  }

  friend bool operator==(const Argument& left, const Argument& right) {
    return left.get() == right.get();
  }

 private:
  struct Borrowed {};
  explicit Argument(Borrowed) noexcept : held_(std::in_place_index<1>, nullptr) {}

  std::variant<T, const T*> held_;
};

}  // namespace skein
