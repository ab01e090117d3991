#include "ad_manager.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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
      member_(entity, values, [this](Tick tick) { manage(tick); }) {
  if (!values.find<bool>("Link").value_or(false)) return;
  joint_.emplace(entity, topic::kLinkPicture, skein::TopicQos{});
  reports_.emplace(entity.publisher<recon::LinkedSites>(topic::kLinkReports.name));
}

void AdManager::manage(Tick tick) {
  bool heard = take_in(tick);
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
  report(tick);
}

/// The joint picture of half a second before: that of this tick waits for what is reported now.
/// What nobody but this aircraft has found says nothing new.
bool AdManager::take_in(Tick tick) {
  if (!joint_) return false;
  const auto joint = joint_->at(tick - topic::kLinkPicture.period);
  const auto state = flight_.at(tick);
  if (!joint || !state) return false;
  if (!frame_) frame_.emplace(geodetic(state->position));
  std::vector<recon::LinkedSite> sites;
  for (const recon::LinkedSite& each : joint->sites)
    if (each.reporters != std::vector{entity_.options().system}) sites.push_back(each);
  if (sites == linked_) return false;
  linked_ = std::move(sites);
  std::vector<LinkTrack> tracks;
  for (const recon::LinkedSite& each : linked_) tracks.push_back(link_track(*frame_, each));
  picture_.report_all(tracks);
  return true;
}

void AdManager::report(Tick tick) {
  if (!reports_) return;
  recon::LinkedSites told{tick, {}};
  for (const Threat& each : threats_)
    if (each.own)
      told.sites.push_back(
          linked_site(*frame_, each.id, each.emitter, *each.own, {entity_.options().system}));
  reports_->publish(told);
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
