#include "ad_manager.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "convert.hpp"
#include "deciding.hpp"
#include "threat_conversion.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

/// Why an estimate is none; nothing if it is one.
std::optional<std::string> is_no_estimate(const recon::PlaceEstimate& place) {
  const double determinant =
      place.north_north_m2 * place.east_east_m2 - place.north_east_m2 * place.north_east_m2;
  if (place.north_north_m2 > 0 && determinant > 0) return std::nullopt;
  return "its covariance is not positive";
}

}  // namespace

AdManager::AdManager(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      flight_(entity, topic::kFlightState),
      emitters_(entity, topic::kEmitters, {}),
      pictures_(
          entity.publisher<recon::ThreatPicture>(topic::kThreats.name, skein::TopicQos::state())),
      member_(entity, values, [this](Tick tick) { manage(tick); }) {}

void AdManager::manage(Tick tick) {
  bool heard = false;
  for (const recon::EmitterReports& reports : emitters_.take(tick)) heard |= hear(reports);
  if (heard) {
    threats_ =
        picture_.threats([this](std::span<const Bearing> bearings, const Interval& distances_m) {
          return locate(bearings, distances_m);
        });
  }
  if (differ(told_, threats_)) {
    told_ = threats_;
    ++epoch_;
  }
  tell(tick);
}

bool AdManager::hear(const recon::EmitterReports& reports) {
  const auto state = flight_.at(reports.tick);
  if (!state) return false;
  if (!frame_) frame_.emplace(geodetic(state->position));
  const Local aircraft = local(*frame_, state->position);
  for (const recon::EmitterReport& each : reports.reports) {
    picture_.hear(intercept(each.intercept, seconds_of(reports.tick)),
                  identification(each.identification), aircraft);
  }
  return !reports.reports.empty();
}

std::optional<skein::fusion::Estimate> AdManager::locate(std::span<const Bearing> bearings,
                                                         const Interval& distances_m) {
  skein::Task<recon::IEmitterLocator, recon::PlaceEstimate> task;
  task.request = "place of an emitter";
  task.features = {{"bearings", static_cast<double>(bearings.size())}};
  const recon::BearingTrack track = bearing_track(bearings, distances_m);
  task.run = [&](recon::IEmitterLocator::Proxy& locator, skein::Duration) {
    return locator.locate(track);
  };
  task.evaluate.check("is an estimate", is_no_estimate);
  const auto place = decide(entity_, task);
  if (!place) return std::nullopt;
  return estimate(*place);
}

void AdManager::tell(Tick tick) {
  recon::ThreatPicture picture{tick, epoch_, {}};
  for (const Threat& each : threats_) {
    const auto types = emitter_types();
    const auto type = std::ranges::find(types, each.emitter, &EmitterType::name);
    recon::Threat& threat = picture.threats.emplace_back();
    threat.number = each.id;
    threat.kind = each.emitter;
    threat.mode = radar_mode(each.mode);
    threat.confidence = each.confidence;
    threat.position = position(*frame_, Local{each.position.mean[0], each.position.mean[1], 0});
    threat.deviation_m = greatest_deviation_m(each.position);
    if (type != types.end()) {
      threat.detection_range_m = type->detection_m;
      threat.lethal_range_m = type->lethal_m;
    }
  }
  pictures_.publish(picture);
}

}  // namespace reconnaissance
