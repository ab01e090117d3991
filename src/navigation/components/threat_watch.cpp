#include "threat_watch.hpp"

#include "core/log.hpp"
#include "skein/error.hpp"

namespace skein::navigation {

std::uint32_t ThreatWatch::epoch(const std::string& terrain) const {
  const std::lock_guard lock(mutex_);
  return known_.terrain == terrain ? known_.epoch : 0;
}

bool ThreatWatch::renew(AE_navigator::Problem& problem) const {
  const std::lock_guard lock(mutex_);
  if (problem.threat_epoch == 0 || known_.terrain != problem.terrain ||
      known_.epoch <= problem.threat_epoch) {
    return false;
  }
  problem.radar_sites = known_.radar_sites;
  problem.missile_sites = known_.missile_sites;
  problem.threat_epoch = known_.epoch;
  return true;
}

void ThreatWatch::ask(const std::string& terrain, Duration patience) {
  try {
    const ConnectOptions options{.timeout = patience};
    auto manager = entity_.connect<AE_adManagerI::IAdManager>(options).within(patience);
    auto picture = manager.threat_picture(terrain);
    const std::lock_guard lock(mutex_);
    if (known_.terrain != terrain || known_.epoch < picture.epoch) known_ = std::move(picture);
  } catch (const std::exception& error) {
    log(LogLevel::Warning, entity_.id(),
        std::string("there is no fresh threat picture: ") + error.what());
  }
}

}  // namespace skein::navigation
