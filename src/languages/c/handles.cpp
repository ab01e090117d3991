#include "handles.hpp"

#include <atomic>
#include <string>

#include "skein/error.hpp"

namespace skein::c {
namespace {

// A number: 4 bits for the shard, 24 for the place in it, 28 for the generation, 8 for the kind.
constexpr unsigned kShardBits = 4;
constexpr unsigned kPlaceBits = 24;
constexpr unsigned kGenerationBits = 28;
constexpr std::uint32_t kLastGeneration = (1U << kGenerationBits) - 1;
constexpr std::size_t kMostPlaces = std::size_t{1} << kPlaceBits;
// So many free places are kept back, so that a number that is used late finds its place empty.
constexpr std::size_t kKeptFree = 64;

struct Number {
  std::size_t shard;
  std::uint32_t place;
  std::uint32_t generation;
  HandleKind kind;

  explicit Number(std::uint64_t id)
      : shard(id & ((1U << kShardBits) - 1)),
        place(static_cast<std::uint32_t>(id >> kShardBits & (kMostPlaces - 1))),
        generation(static_cast<std::uint32_t>(id >> (kShardBits + kPlaceBits) & kLastGeneration)),
        kind(static_cast<HandleKind>(id >> 56)) {}
};

std::uint64_t number_of(std::size_t shard, std::size_t place, std::uint32_t generation,
                        HandleKind kind) {
  return shard | std::uint64_t{place} << kShardBits |
         std::uint64_t{generation} << (kShardBits + kPlaceBits) |
         static_cast<std::uint64_t>(kind) << 56;
}

const char* name_of(HandleKind kind) {
  static constexpr const char* kNames[] = {"error", "result",    "entity",      "interface",
                                           "proxy", "call",      "stream",      "provider",
                                           "reply", "publisher", "subscription"};
  const auto index = static_cast<std::size_t>(kind) - 1;
  return index < std::size(kNames) ? kNames[index] : nullptr;
}

[[noreturn]] void refuse(std::uint64_t id, HandleKind wanted, bool freed) {
  const std::string type = std::string("skein_") + name_of(wanted);
  const char* const other = name_of(Number(id).kind);
  if (id == 0) throw InvalidArgument("the " + type + " is 0, which names none: make one first");
  if (!other) throw InvalidArgument(std::to_string(id) + " is no handle that Skein has made");
  if (Number(id).kind != wanted) {
    throw InvalidArgument("a skein_" + std::string(other) + " was given in place of a " + type);
  }
  throw InvalidArgument(freed ? "this " + type + " was freed, or has ended, before"
                              : "this " + type + " was never made");
}

}  // namespace

Handles& Handles::all() {
  static auto& handles = *new Handles;
  return handles;
}

std::uint64_t Handles::add(HandleKind kind, std::shared_ptr<void> object) {
  static std::atomic<std::size_t> next{0};
  const std::size_t index = next++ % kShards;
  Shard& shard = shards_[index];
  std::lock_guard lock(shard.mutex);
  if (shard.free.size() <= kKeptFree) {
    if (shard.places.size() >= kMostPlaces) {
      throw Overloaded("there are too many handles; free those that are not used any more");
    }
    shard.free.push_back(static_cast<std::uint32_t>(shard.places.size()));
    shard.places.emplace_back();
  }
  const std::uint32_t at = shard.free.front();
  shard.free.pop_front();
  Place& place = shard.places[at];
  place.kind = kind;
  place.object = std::move(object);
  return number_of(index, at, place.generation, kind);
}

Handles::Place& Handles::place_of(Shard& shard, std::uint64_t id, HandleKind kind) {
  const Number number(id);
  if (id == 0 || number.kind != kind || number.place >= shard.places.size())
    refuse(id, kind, false);
  Place& place = shard.places[number.place];
  if (place.generation == number.generation && place.kind == kind && place.object) return place;
  refuse(id, kind, number.generation <= place.generation);
}

std::shared_ptr<void> Handles::find(std::uint64_t id, HandleKind kind) {
  Shard& shard = shards_[Number(id).shard];
  std::lock_guard lock(shard.mutex);
  return place_of(shard, id, kind).object;
}

std::shared_ptr<void> Handles::remove(std::uint64_t id, HandleKind kind) {
  Shard& shard = shards_[Number(id).shard];
  std::lock_guard lock(shard.mutex);
  Place& place = place_of(shard, id, kind);
  // A place whose generations are used up is not used again.
  if (++place.generation < kLastGeneration) shard.free.push_back(Number(id).place);
  return std::move(place.object);
}

}  // namespace skein::c
