#pragma once

#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

namespace skein {

/// A value of its own memory: the member, @external or @optional, by which a type contains itself,
/// or what is too large for a stack. A copy copies the value. Without one it stands for the initial
/// value of T.
template <class T>
class Box {
 public:
  Box() = default;
  template <class U>
  requires std::same_as<std::remove_cvref_t<U>, T> Box(U&& value)
      : value_(std::make_unique<T>(std::forward<U>(value))) {}
  Box(const Box& other) : value_(other.value_ ? std::make_unique<T>(*other.value_) : nullptr) {}
  Box(Box&&) noexcept = default;
  Box& operator=(const Box& other) {
    if (this != &other) *this = Box(other);
    return *this;
  }
  Box& operator=(Box&&) noexcept = default;

  const T& operator*() const {
    static const T kInitial{};
    return value_ ? *value_ : kInitial;
  }
  T& operator*() {
    if (!value_) value_ = std::make_unique<T>();
    return *value_;
  }
  const T* operator->() const { return &**this; }
  T* operator->() { return &**this; }
  operator const T&() const { return **this; }

  friend bool operator==(const Box& left, const Box& right) { return *left == *right; }

 private:
  std::unique_ptr<T> value_;
};

}  // namespace skein
