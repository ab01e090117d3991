#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include "skein/detail/version.hpp"

namespace skein {

/// A move-only std::function<void()>. Callables of up to 48 bytes that move without throwing are
/// stored in place, so that passing a call on takes nothing from the heap.
class Action {
 public:
  Action() = default;
  Action(std::nullptr_t) {}

  template <class Run>
  requires(!std::is_same_v<std::decay_t<Run>, Action> && std::is_invocable_v<std::decay_t<Run>&>)
      Action(Run&& run) {
    using Held = std::decay_t<Run>;
    if constexpr (fits<Held>()) {
      new (room_) Held(std::forward<Run>(run));
      kind_ = &kInPlace<Held>;
    } else {
      new (room_) Held*(new Held(std::forward<Run>(run)));
      kind_ = &kOnHeap<Held>;
    }
  }

  Action(Action&& other) noexcept { take(other); }
  Action& operator=(Action&& other) noexcept {
    if (this != &other) {
      clear();
      take(other);
    }
    return *this;
  }
  ~Action() { clear(); }

  explicit operator bool() const noexcept { return kind_ != nullptr; }
  void operator()() { kind_->run(room_); }

 private:
  static constexpr std::size_t kRoom = 48;

  struct Kind {
    void (*run)(void* room);
    void (*move)(void* to, void* from) noexcept;  // and destroys `from`
    void (*end)(void* room) noexcept;
  };

  template <class Held>
  static constexpr bool fits() {
    return sizeof(Held) <= kRoom && alignof(Held) <= alignof(std::max_align_t) &&
           std::is_nothrow_move_constructible_v<Held>;
  }

  template <class Held>
  static Held& held(void* room) noexcept {
    return *std::launder(static_cast<Held*>(room));
  }

  template <class Held>
  static constexpr Kind kInPlace{[](void* room) { held<Held>(room)(); },
                                 [](void* to, void* from) noexcept {
                                   new (to) Held(std::move(held<Held>(from)));
                                   held<Held>(from).~Held();
                                 },
                                 [](void* room) noexcept { held<Held>(room).~Held(); }};

  template <class Held>
  static constexpr Kind kOnHeap{
      [](void* room) { (*held<Held*>(room))(); },
      [](void* to, void* from) noexcept { new (to) Held*(held<Held*>(from)); },
      [](void* room) noexcept { delete held<Held*>(room); }};

  void take(Action& other) noexcept {
    kind_ = std::exchange(other.kind_, nullptr);
    if (kind_) kind_->move(room_, other.room_);
  }
  void clear() noexcept {
    if (const Kind* const kind = std::exchange(kind_, nullptr)) kind->end(room_);
  }

  alignas(std::max_align_t) std::byte room_[kRoom];
  const Kind* kind_ = nullptr;
};

}  // namespace skein
