#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>

#include "skein/c/skein.h"

namespace skein::c {

/// The kinds of objects that handles name.
enum class HandleKind : std::uint8_t {
  Error = 1,
  Result,
  Entity,
  Interface,
  Proxy,
  Call,
  Stream,
  Provider,
  Reply,
  Publisher,
  Subscription,
};

/// All objects that handles name. A number is never given twice: it has the kind, the place, and
/// how often the place was used before. Thread-safe.
class Handles {
 public:
  /// The process's; never destroyed.
  static Handles& all();

  std::uint64_t add(HandleKind kind, std::shared_ptr<void> object);
  /// Throws InvalidArgument, which says what the number is.
  std::shared_ptr<void> find(std::uint64_t id, HandleKind kind);
  /// As find(); from now on the number names nothing.
  std::shared_ptr<void> remove(std::uint64_t id, HandleKind kind);

 private:
  struct Place {
    std::uint32_t generation = 1;
    HandleKind kind{};
    std::shared_ptr<void> object{};
  };
  struct Shard {
    std::mutex mutex;
    std::deque<Place> places;
    std::deque<std::uint32_t> free;
  };
  /// The place of a number, under the shard's lock.
  static Place& place_of(Shard& shard, std::uint64_t id, HandleKind kind);

  static constexpr std::size_t kShards = 16;
  std::array<Shard, kShards> shards_;
};

/// Which C struct names which class.
template <class Object>
struct Named;

#define SKEIN_NAMES(handle, kind_, object)                 \
  template <>                                              \
  struct Named<object> {                                   \
    using Handle = handle;                                 \
    static constexpr HandleKind kKind = HandleKind::kind_; \
  }

template <class Object>
typename Named<Object>::Handle add(std::shared_ptr<Object> object) {
  return {Handles::all().add(Named<Object>::kKind, std::move(object))};
}
template <class Object>
std::shared_ptr<Object> find(typename Named<Object>::Handle handle) {
  return std::static_pointer_cast<Object>(Handles::all().find(handle.id, Named<Object>::kKind));
}
/// Null for 0.
template <class Object>
std::shared_ptr<Object> remove(typename Named<Object>::Handle handle) {
  if (handle.id == 0) return nullptr;
  return std::static_pointer_cast<Object>(Handles::all().remove(handle.id, Named<Object>::kKind));
}

}  // namespace skein::c
