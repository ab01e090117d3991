#pragma once

#include <cstdint>
#include <unordered_map>

#include "skein/detail/qos.hpp"
#include "skein/guid.hpp"

namespace skein::dds {

/// Which writer owns each instance of a reader with exclusive ownership (DDS 1.4, 2.2.3.9): the
/// strongest living one, of equals the one with the lesser GUID. Not thread-safe.
class Ownership {
 public:
  /// Whether the writer, of which a sample came, owns the instance; it may become the owner now.
  bool owns(const KeyHash& key, const Guid& writer, std::int32_t strength);

  /// The writer has gone, or is silent: others may own its instances.
  void release_all(const Guid& writer);
  /// The writer lets go of one instance.
  void release(const KeyHash& key, const Guid& writer);
  /// The instance's owner, whoever it is, missed the deadline.
  void release(const KeyHash& key);

 private:
  struct Owner {
    Guid writer;
    std::int32_t strength;
  };

  std::unordered_map<KeyHash, Owner> owners_;
};

}  // namespace skein::dds
