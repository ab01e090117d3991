#include "report/joint_record.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "traffic/encounter.hpp"

namespace reconnaissance {
namespace {

// So near to each other two sites of one kind are the same.
constexpr double kSameSite_m = 3000;

template <class Item>
void append(std::vector<Item>& items, const std::vector<Item>& more) {
  items.insert(items.end(), more.begin(), more.end());
}

void name_aircraft(MissionRecord& record, const std::string& aircraft) {
  for (DecisionTold& each : record.decisions) each.entity = aircraft + " " + each.entity;
  for (Fault& each : record.faults) each.noticed_by = aircraft + " " + each.noticed_by;
  for (Flag& each : record.flags) each.text = aircraft + ": " + each.text;
  for (Latencies& each : record.latencies) each.name = aircraft + " " + each.name;
  std::erase_if(record.others,
                [](const OtherTrack& each) { return each.number >= kFirstCompanion; });
}

/// Known since it was known first, and where it is known best.
void know(std::vector<KnownThreat>& threats, const KnownThreat& more) {
  const auto same = std::ranges::find_if(threats, [&](const KnownThreat& each) {
    return each.kind == more.kind &&
           std::hypot(each.place.north_m - more.place.north_m,
                      each.place.east_m - more.place.east_m) < kSameSite_m;
  });
  if (same == threats.end()) {
    threats.push_back(more);
    return;
  }
  const double from_s = std::min(same->from_s, more.from_s);
  if (more.deviation_m < same->deviation_m) *same = more;
  same->from_s = from_s;
}

}  // namespace

MissionRecord joint_record(const std::vector<OfAircraft<MissionRecord>>& records) {
  MissionRecord joint;
  std::vector<KnownThreat> threats;
  for (std::size_t i = 0; i < records.size(); ++i) {
    MissionRecord own = records[i].what;
    name_aircraft(own, records[i].aircraft);
    for (const KnownThreat& each : own.threats) know(threats, each);
    if (i == 0) {
      joint = std::move(own);
      continue;
    }
    OtherTrack track{kFirstCompanion + static_cast<std::uint32_t>(i) - 1, {}, records[i].aircraft};
    for (const TrackPoint& each : own.track) track.points.push_back({each.time_s, each.place});
    joint.others.push_back(std::move(track));
    joint.tracked_s += own.tracked_s;
    joint.survival *= own.survival;
    joint.lost_samples += own.lost_samples;
    append(joint.others, own.others);
    append(joint.targets, own.targets);
    append(joint.footprints, own.footprints);
    append(joint.decisions, own.decisions);
    append(joint.faults, own.faults);
    append(joint.flags, own.flags);
    append(joint.latencies, own.latencies);
  }
  joint.threats = std::move(threats);
  std::ranges::stable_sort(joint.footprints, {}, &ImagedGround::time_s);
  std::ranges::stable_sort(joint.decisions, {}, &DecisionTold::time_s);
  std::ranges::stable_sort(joint.faults, {}, &Fault::from_s);
  return joint;
}

}  // namespace reconnaissance
