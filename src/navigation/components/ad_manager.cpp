#include "ad_manager.hpp"

#include <fmt/core.h>

#include "navigation/routes/demo_problem.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

using AE_adManagerI::InvalidReport;
using AE_adManagerI::ThreatPicture;

constexpr std::size_t kMaxTerrains = 16;
constexpr std::size_t kMaxSites = 1000;

template <class Sites>
void put(Sites& sites, const typename Sites::value_type& site) {
  std::erase_if(sites, [&](const auto& known) { return known.name == site.name; });
  if (sites.size() >= kMaxSites)
    throw InvalidReport(fmt::format("a picture holds {} sites at most", kMaxSites));
  sites.push_back(site);
}

}  // namespace

ThreatPicture& AdManager::picture_of(const std::string& terrain) {
  if (const auto known = pictures_.find(terrain); known != pictures_.end()) return known->second;
  if (pictures_.size() >= kMaxTerrains)
    throw InvalidReport(fmt::format("pictures of {} terrains are kept at most", kMaxTerrains));
  try {
    const auto problem = demo_problem(*terrains_->load(terrain));
    return pictures_[terrain] = {terrain, 1, problem.radar_sites, problem.missile_sites};
  } catch (const InvalidArgument& error) {
    throw InvalidReport(error.what());
  }
}

ThreatPicture AdManager::threat_picture(const std::string& terrain) { return picture_of(terrain); }

ThreatPicture AdManager::radar_found(const std::string& terrain,
                                     const AE_navigator::RadarSite& radar) {
  ThreatPicture& picture = picture_of(terrain);
  put(picture.radar_sites, radar);
  ++picture.epoch;
  return picture;
}

ThreatPicture AdManager::radar_silent(const std::string& terrain, const std::string& name) {
  ThreatPicture& picture = picture_of(terrain);
  const auto gone =
      std::erase_if(picture.radar_sites, [&](const auto& known) { return known.name == name; });
  if (gone == 0) throw InvalidReport(fmt::format("there is no radar '{}' to fall silent", name));
  ++picture.epoch;
  return picture;
}

ThreatPicture AdManager::missiles_found(const std::string& terrain,
                                        const AE_navigator::MissileSite& missiles) {
  ThreatPicture& picture = picture_of(terrain);
  put(picture.missile_sites, missiles);
  ++picture.epoch;
  return picture;
}

}  // namespace skein::navigation
