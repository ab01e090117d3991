#include "sample_gate.hpp"

#include <tuple>

namespace skein::dds {

SourceTime wall_clock_time() { return std::chrono::system_clock::now().time_since_epoch(); }

std::optional<SourceTime> SampleGate::admit(const KeyHash& key, const Guid& from,
                                            const Writer& writer, SourceTime written,
                                            SourceTime now) {
  const SourceTime expiry = writer.lifespan ? written + *writer.lifespan : kNever;
  if (!fresh(expiry, now)) return std::nullopt;
  if (exclusive_ && !owns(key, from, writer.strength)) return std::nullopt;
  return expiry;
}

bool SampleGate::fresh(SourceTime expiry, SourceTime now) {
  if (now < expiry) return true;
  expired_.fetch_add(1, std::memory_order_relaxed);
  return false;
}

/// Whether the writer is the instance's owner, or becomes it now.
bool SampleGate::owns(const KeyHash& key, const Guid& writer, std::int32_t strength) {
  const auto [found, unowned] = owners_.try_emplace(key, Owner{writer, strength});
  Owner& owner = found->second;
  if (unowned || owner.writer == writer) return true;
  // Of equals the lesser GUID.
  if (std::tie(owner.strength, writer) >= std::tie(strength, owner.writer)) return false;
  owner = {writer, strength};
  return true;
}

void SampleGate::release_all(const Guid& writer) {
  std::erase_if(owners_, [&](const auto& entry) { return entry.second.writer == writer; });
}

void SampleGate::release(const KeyHash& key, const Guid& writer) {
  const auto found = owners_.find(key);
  if (found != owners_.end() && found->second.writer == writer) owners_.erase(found);
}

void SampleGate::release(const KeyHash& key) { owners_.erase(key); }

}  // namespace skein::dds
