#pragma once

#include <mutex>
#include <optional>

#include "ad_manager.idl.hpp"
#include "skein/entity.hpp"

namespace skein::navigation {

/// What the navigator knows of the threats in its world: the newest picture that the AD manager
/// gave it. Thread-safe.
class ThreatWatch {
 public:
  /// `entity` outlives it.
  explicit ThreatWatch(Entity& entity) : entity_(entity) {}

  /// The epoch of the newest picture of that terrain; 0 where there is none.
  std::uint32_t epoch(const std::string& terrain) const;

  /// Gives the problem the threats of a newer picture; false where none is known, or the threats
  /// are the caller's own.
  bool renew(AE_navigator::Problem& problem) const;

  /// Asks the AD manager for its picture of that terrain, for `patience` at most. Where it does not
  /// answer, what was known stays; that is logged.
  void ask(const std::string& terrain, Duration patience);

 private:
  Entity& entity_;
  mutable std::mutex mutex_;
  AE_adManagerI::ThreatPicture known_;
};

}  // namespace skein::navigation
