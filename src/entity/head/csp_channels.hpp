#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "brokerless_discovery/broker.hpp"
#include "head_parts.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

namespace skein::entity {

/// A Head's connections to CSPs, kept from one request to the next. Thread-safe.
class CspChannels {
 public:
  /// `parts` outlives it.
  explicit CspChannels(const Head::Parts& parts) : parts_(parts) {}

  /// Waits no longer than `patience` for a new connection; `now` is the time when it stands.
  std::shared_ptr<Channel> open(const Candidate& candidate, Duration patience, Instant& now) {
    {
      std::lock_guard lock(mutex_);
      const auto found = channels_.find(candidate.provider);
      if (found != channels_.end() && found->second->connected()) return found->second;
      std::erase_if(channels_, [](const auto& entry) { return !entry.second->connected(); });
    }
    for (const auto& description : parts_.broker.all()) {
      if (description->provider != candidate.provider.bytes) continue;
      auto channel = parts_.connector.open_provider(*description, {}, patience);
      now = parts_.clock.now();
      std::lock_guard lock(mutex_);
      return channels_.insert_or_assign(candidate.provider, std::move(channel)).first->second;
    }
    throw Unavailable(candidate.name + " left before it could be asked");
  }

 private:
  const Head::Parts& parts_;
  std::mutex mutex_;
  std::map<Guid, std::shared_ptr<Channel>> channels_;
};

}  // namespace skein::entity
