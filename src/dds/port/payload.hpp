#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace skein::dds {

/// A received sample's bytes, held by whatever a back end's vendor lends or hands over: a counted
/// reference, a buffer. The holder lies in place, so that to queue a sample takes no memory for it.
/// Move-only; not thread-safe.
class Payload {
 public:
  /// Without bytes: a disposal's.
  Payload() = default;

  /// `holder` owns `cdr`, which stays where it is when the holder is moved, and hands the ownership
  /// over with `std::shared_ptr<const void> keep()`.
  template <class Holder>
  Payload(std::span<const std::byte> cdr, Holder holder) : cdr_(cdr), kind_(&kKind<Holder>) {
    static_assert(sizeof(Holder) <= kRoom && alignof(Holder) <= alignof(void*));
    static_assert(std::is_nothrow_move_constructible_v<Holder>);
    new (room_) Holder(std::move(holder));
  }

  Payload(Payload&& other) noexcept { take(other); }
  Payload& operator=(Payload&& other) noexcept {
    if (this != &other) {
      clear();
      take(other);
    }
    return *this;
  }
  ~Payload() { clear(); }

  std::span<const std::byte> cdr() const noexcept { return cdr_; }

  /// What keeps cdr() valid from now on; once. Nothing where there are no bytes.
  std::shared_ptr<const void> keep() { return kind_ != nullptr ? kind_->keep(room_) : nullptr; }

 private:
  static constexpr std::size_t kRoom = 4 * sizeof(void*);

  struct Kind {
    std::shared_ptr<const void> (*keep)(void* room);
    void (*move)(void* to, void* from) noexcept;  // and ends what was there
    void (*end)(void* room) noexcept;
  };

  template <class Holder>
  static Holder& held(void* room) noexcept {
    return *std::launder(static_cast<Holder*>(room));
  }

  template <class Holder>
  static constexpr Kind kKind{
      [](void* room) -> std::shared_ptr<const void> { return held<Holder>(room).keep(); },
      [](void* to, void* from) noexcept {
        new (to) Holder(std::move(held<Holder>(from)));
        held<Holder>(from).~Holder();
      },
      [](void* room) noexcept { held<Holder>(room).~Holder(); }};

  void take(Payload& other) noexcept {
    cdr_ = std::exchange(other.cdr_, {});
    kind_ = std::exchange(other.kind_, nullptr);
    if (kind_ != nullptr) kind_->move(room_, other.room_);
  }
  void clear() noexcept {
    if (const Kind* const kind = std::exchange(kind_, nullptr)) kind->end(room_);
  }

  std::span<const std::byte> cdr_;
  alignas(void*) std::byte room_[kRoom];
  const Kind* kind_ = nullptr;
};

}  // namespace skein::dds
