#pragma once

#include <map>
#include <memory>

#include "ad_manager.idl.hpp"
#include "navigation/terrain/terrain_provider.hpp"

namespace skein::navigation {

/// The AD manager's Body: a stand-in that fuses nothing, but keeps for each terrain what is
/// reported to it. The first picture of a terrain shows the radars of demo_problem(). Not
/// thread-safe: for a service of one thread.
class AdManager final : public AE_adManagerI::IAdManager {
 public:
  explicit AdManager(std::shared_ptr<TerrainProvider> terrains) : terrains_(std::move(terrains)) {}

  AE_adManagerI::ThreatPicture threat_picture(const std::string& terrain) override;
  AE_adManagerI::ThreatPicture radar_found(const std::string& terrain,
                                           const AE_navigator::RadarSite& radar) override;
  AE_adManagerI::ThreatPicture radar_silent(const std::string& terrain,
                                            const std::string& name) override;
  AE_adManagerI::ThreatPicture missiles_found(const std::string& terrain,
                                              const AE_navigator::MissileSite& missiles) override;

 private:
  AE_adManagerI::ThreatPicture& picture_of(const std::string& terrain);

  std::shared_ptr<TerrainProvider> terrains_;
  std::map<std::string, AE_adManagerI::ThreatPicture> pictures_;
};

}  // namespace skein::navigation
