#include "ownership.hpp"

#include <tuple>

namespace skein::dds {

bool Ownership::owns(const KeyHash& key, const Guid& writer, std::int32_t strength) {
  const auto [found, unowned] = owners_.try_emplace(key, Owner{writer, strength});
  Owner& owner = found->second;
  if (unowned || owner.writer == writer) return true;
  if (std::tie(owner.strength, writer) >= std::tie(strength, owner.writer)) return false;
  owner = {writer, strength};
  return true;
}

void Ownership::release_all(const Guid& writer) {
  std::erase_if(owners_, [&](const auto& entry) { return entry.second.writer == writer; });
}

void Ownership::release(const KeyHash& key, const Guid& writer) {
  const auto found = owners_.find(key);
  if (found != owners_.end() && found->second.writer == writer) owners_.erase(found);
}

void Ownership::release(const KeyHash& key) { owners_.erase(key); }

}  // namespace skein::dds
