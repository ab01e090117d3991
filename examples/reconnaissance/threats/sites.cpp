#include "threats/sites.hpp"

#include <algorithm>
#include <cmath>

#include "skein/error.hpp"
#include "threats/emitter_classification.hpp"

namespace reconnaissance {
namespace {

constexpr double kMast_m = 10;
constexpr double kBoltzmann_J_K = 1.380649e-23;
// Of one look at a probability of 0.9 and of a false alarm of 1e-6, by North's approximation.
constexpr double kSignalToNoise = 20.8;
constexpr double kWeaponHeight_m = 5000;
// Once it guides, an aircraft in its zone lives for 50 s on average.
constexpr double kSiteKills_per_s = 0.02;

const EmitterType& find_type(const std::string& name) {
  std::string known;
  for (const EmitterType& type : emitter_types()) {
    if (type.name == name) return type;
    known += (known.empty() ? "" : ", ") + type.name;
  }
  throw skein::InvalidArgument("'" + name + "' is no site; there are " + known);
}

double middle(const Interval& interval) { return (interval.least + interval.greatest) / 2; }

/// That of search where the type has no such mode.
Waveform waveform_of(const std::string& type, RadarMode mode) {
  const auto library = emitter_library();
  const auto is = [&](RadarMode wanted) {
    return [&type, wanted](const EmitterClass& each) {
      return each.type == type && each.mode == wanted;
    };
  };
  auto found = std::find_if(library.begin(), library.end(), is(mode));
  if (found == library.end())
    found = std::find_if(library.begin(), library.end(), is(RadarMode::Search));
  return {middle(found->radio_frequency_hz), middle(found->pulse_interval_s),
          middle(found->scan_s)};
}

}  // namespace

RadarSite site_of_type(const std::string& type, std::uint32_t emitter, const Local& ground,
                       double active_from_s) {
  const EmitterType& known = find_type(type);
  RadarSite site{};
  site.emitter = emitter;
  site.antenna = {ground.north_m, ground.east_m, ground.height_m + kMast_m};
  site.active_from_s = active_from_s;
  site.constant_j_m2_k = kSignalToNoise * kBoltzmann_J_K * std::pow(known.detection_m, 4);
  site.radiated_power_w = known.radiated_power_w;
  site.search = waveform_of(type, RadarMode::Search);
  site.track = waveform_of(type, RadarMode::Track);
  site.guidance = waveform_of(type, RadarMode::Guidance);
  site.zone = {.greatest_range_m = known.lethal_m,
               .greatest_height_m = kWeaponHeight_m,
               .kills_per_s = known.lethal_m > 0 ? kSiteKills_per_s : 0};
  return site;
}

}  // namespace reconnaissance
