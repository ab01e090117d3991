#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "geodesy/hills.hpp"
#include "random.hpp"
#include "report/report.hpp"

namespace reconnaissance::test {

/// Flies points one after the other, at 60 m/s, with banked turns of at most 30 degrees, some 300 m
/// above the ground, and stops at the last one.
inline std::vector<TrackPoint> flight_over(const std::vector<Local>& points, const Hills& hills) {
  constexpr double kSpeed_m_s = 60, kGravity_m_s2 = 9.80665, kStep_s = 1;
  constexpr double kPi = std::numbers::pi;
  std::vector<TrackPoint> track;
  TrackPoint now;
  now.place = points.front();
  now.heading_rad = 80 * kPi / 180;
  now.fuel_kg = 80;
  std::size_t next = 1;
  while (next < points.size() && track.size() < 4000) {
    const bool last = next + 1 == points.size();
    const double north = points[next].north_m - now.place.north_m;
    const double east = points[next].east_m - now.place.east_m;
    const double away = std::hypot(north, east);
    if (away < (last ? 40 : 600)) {
      ++next;
      continue;
    }
    const double wanted_m =
        hills(now.place.north_m, now.place.east_m) + (last ? std::min(300.0, away * 0.07) : 300.0);
    const double off = std::remainder(std::atan2(east, north) - now.heading_rad, 2 * kPi);
    const double speed = std::min(kSpeed_m_s, 12 + 2.5 * now.time_s);
    now.bank_rad = std::clamp(1.5 * off, -kPi / 6, kPi / 6);
    now.heading_rad += kGravity_m_s2 * std::tan(now.bank_rad) / speed * kStep_s;
    now.climb_rad = now.time_s < 20
                        ? 0.0
                        : std::clamp((wanted_m - now.place.height_m) / (5 * speed), -0.09, 0.11);
    now.place.north_m += speed * std::cos(now.heading_rad) * kStep_s;
    now.place.east_m += speed * std::sin(now.heading_rad) * kStep_s;
    const double ground_m = hills(now.place.north_m, now.place.east_m);
    now.place.height_m =
        std::max(now.place.height_m + speed * std::sin(now.climb_rad) * kStep_s, ground_m);
    now.height_above_ground_m = now.place.height_m - ground_m;
    now.airspeed_m_s = now.ground_speed_m_s = speed;
    now.fuel_kg -= 0.012 * kStep_s;
    now.time_s += kStep_s;
    track.push_back(now);
  }
  now.bank_rad = now.climb_rad = now.height_above_ground_m = 0;
  now.place.height_m = hills(now.place.north_m, now.place.east_m);
  for (; now.ground_speed_m_s > 0; now.time_s += kStep_s) {  // it brakes
    now.place.north_m += now.ground_speed_m_s * std::cos(now.heading_rad) * kStep_s;
    now.place.east_m += now.ground_speed_m_s * std::sin(now.heading_rad) * kStep_s;
    now.airspeed_m_s = now.ground_speed_m_s = std::max(0.0, now.ground_speed_m_s - 4 * kStep_s);
    track.push_back(now);
  }
  return track;
}

/// When a track was nearest to a place.
inline double nearest_s(const std::vector<TrackPoint>& track, const Local& place) {
  return std::ranges::min_element(track, {},
                                  [&](const TrackPoint& point) {
                                    return std::hypot(point.place.north_m - place.north_m,
                                                      point.place.east_m - place.east_m);
                                  })
      ->time_s;
}

inline DecisionTold decision(double time_s, const char* entity, const char* question,
                             const char* chosen, const char* reason, double took_s) {
  return {time_s, entity, question, chosen, reason, {{chosen, "accepted", reason, took_s}},
          took_s, false};
}

/// A mission as it might have been flown: a pop-up threat on the way home, another aircraft, a set
/// of sensors that is wrong, a planner that dies.
inline MissionRecord flown_mission() {
  const Hills hills(180, 7);
  MissionRecord record;
  record.mission = "reconnaissance";
  record.command =
      "skein launch mission_profiles/reconnaissance/reconnaissance.xml --variable seed=7";
  record.origin = {53.3, 27.4, 180};
  const std::vector<Local> points{
      {0, 0, 180},       {1500, 8500, 0},  {8000, 9500, 0},   {12500, 12600, 0}, {13000, 18800, 0},
      {11650, 20700, 0}, {9160, 22400, 0}, {6200, 20600, 0},  {4500, 15900, 0},  {1800, 11200, 0},
      {3600, 4200, 0},   {2500, -5200, 0}, {-1389, -8200, 0}, {-700, -4000, 0},  {25, 140, 180}};
  record.track = flight_over(points, hills);
  const double end_s = record.track.back().time_s;

  record.targets = {
      {"depot", {{11700, 13200, 0}}, 3, 0.3, 0.19, 4, {}, {}},
      {"road", {{11650, 20700, 0}, {10300, 21900, 0}, {9160, 22400, 0}}, 2, 0.3, 0.24, 7, {}, {}},
      {"bridge", {{4500, 15900, 0}}, 2, 0.3, 0.21, 3, {}, {}}};
  for (Target& target : record.targets) {
    const Local& place = target.line.back();
    target.collected_s = nearest_s(record.track, place);
    for (int i = -6; i <= 0; ++i) {
      const double time_s = *target.collected_s + 2 * i;
      const double wide = 180, north = place.north_m + 60.0 * (i + 3), east = place.east_m - 20 * i;
      record.footprints.push_back({time_s,
                                   target.name,
                                   {{north - wide, east - wide, 0},
                                    {north - wide, east + wide, 0},
                                    {north + wide, east + 1.3 * wide, 0},
                                    {north + wide, east - 1.3 * wide, 0}},
                                   target.achieved_sample_m});
    }
  }
  std::ranges::sort(record.footprints, {}, &ImagedGround::time_s);
  const double depot_s = *record.targets[0].collected_s, road_s = *record.targets[1].collected_s,
               bridge_s = *record.targets[2].collected_s;

  record.threats = {{1, "short-range site", 95, {19950, 6650, 0}, 180, 18000, 5000},
                    {2, "medium-range site", 140, {27800, 36500, 0}, 420, 34000, 14000},
                    {3, "short-range site", bridge_s + 20, {-4450, 13300, 0}, 260, 18000, 5000}};
  record.zones = {{"town", {{6500, 1200, 0}, {9400, 2600, 0}, {8400, 5600, 0}, {5900, 4300, 0}}}};

  const double turned_s = bridge_s + 26;
  record.routes = {{20, "AStar", {points.begin(), points.begin() + 9}},
                   {depot_s + 12, "AStar", {points.begin() + 4, points.begin() + 9}},
                   {turned_s, "RRTConnect", {points.begin() + 8, points.end()}}};
  record.routes[0].points.push_back({200, 4000, 0});
  record.phases = {{0, "BuiltInTest", "waits until everybody is fine"},
                   {4, "TakeOff", "all tests are passed"},
                   {48, "Ingress", "planned: depot, road, bridge"},
                   {depot_s - 60, "Collection", "the first element is near"},
                   {bridge_s + 10, "Egress", "all elements are collected"},
                   {end_s - 150, "Landing", "the centre line is reached"},
                   {end_s - 6, "Complete", "the aircraft stands"}};
  record.modes = {{0, "Starting", ""},
                  {4, "Normal", ""},
                  {252, "Limited", "set 2 of the sensors is wrong"},
                  {406, "Normal", ""}};

  OtherTrack other{1, {}};
  for (double time_s = 150; time_s <= 330; time_s += 2)
    other.points.push_back(
        {time_s, {14500 - 40 * (time_s - 150), 15400 - 44 * (time_s - 150), 560}});
  record.others = {other};

  record.decisions = {
      decision(20, "mission_manager", "which elements, in which order", "Exact",
               "3 elements are left: all orders can be compared, and this one collects the value "
               "10.0 in 1210 s with 61 kg of fuel.",
               0.0041),
      decision(
          22, "navigator", "a route over depot, road, bridge", "AStar",
          "It answered 3 of 3 similar requests within 128 ms at quality 0.88; RRTConnect would "
          "have followed.",
          0.131),
      decision(depot_s - 60, "eoi_manager", "the element to be looked at next", "ByValue",
               "depot is worth most for its time: priority 3, 58 s away.", 0.0006),
      decision(depot_s - 55, "eo_manager", "a pattern for depot", "Spot",
               "It sees all of the depot at 0.19 m a pixel in 9 s; LineScan needs 14 s, and "
               "StepStare 22 s.",
               0.0022),
      decision(
          96, "radar_warner", "which radar is that", "vote",
          "TableMatch and Bayesian say short-range site with 0.93 and 0.97; Wideband abstains.",
          0.0011),
      decision(188, "collision_manager", "an aircraft on collision course", "Bands",
               "Corrective alert in 55 s; 24 degrees to the right keep well clear and cost least.",
               0.0017),
      decision(road_s - 70, "eo_manager", "a pattern for road", "LineScan",
               "The road is 2.9 km long; one line of images along it leaves nothing out.", 0.0026),
      decision(bridge_s - 58, "eo_manager", "a pattern for bridge", "Spot",
               "It sees all of the bridge at 0.21 m a pixel.", 0.0021)};
  DecisionTold around{turned_s,
                      "navigator",
                      "a way home around the site that popped up",
                      "RRTConnect",
                      "AStar was asked first, and its process was killed after 61 ms. RRTConnect "
                      "answers in time, and its route survives with 0.99.",
                      {{"AStar", "disconnected", "best quality by the deadline", 0.061},
                       {"RRTConnect", "accepted", "answered 14 of the other 14", 0.024}},
                      0.092,
                      true};
  record.decisions.push_back(around);
  std::ranges::sort(record.decisions, {}, &DecisionTold::time_s);

  record.faults = {{250, 406, "Set 2 of the sensors is wrong", "flight_controller", 251.1,
                    "It was left out, and heard again when it had agreed for five seconds."},
                   {turned_s, turned_s + 0.4, "The planner AStar was killed", "navigator", turned_s,
                    "The kernel told of it; the Head asked RRTConnect, and the launcher started "
                    "AStar again."}};
  record.flags = {
      {bridge_s + 20, false, "A short-range site popped up 4.6 km beside the route home"},
      {188, false, "Another aircraft came within 55 s of not being well clear"}};

  Random random(11);
  const auto spread = [&](const char* name, double median_s, double factor, int count) {
    Latencies latencies{name, {}};
    for (int i = 0; i < count; ++i)
      latencies.seconds.push_back(
          median_s *
          std::exp(factor * (random.uniform() + random.uniform() + random.uniform() - 1.5)));
    record.latencies.push_back(latencies);
  };
  spread("navigator: AStar", 0.12, 0.6, 22);
  spread("navigator: RRTConnect", 0.021, 1.6, 31);
  spread("mission_manager: Exact", 0.004, 0.7, 40);
  spread("eo_manager: Spot", 0.0021, 0.5, 160);
  spread("radar_warner: Bayesian", 0.0005, 0.9, 900);
  spread("collision_manager: Bands", 0.0016, 0.5, 120);

  record.verdict.flown = record.verdict.passed = true;
  record.verdict.duration_s = end_s - 22;
  record.verdict.distance_m = 60 * (end_s - 22);
  record.verdict.checks = {
      {"flown to its end", true, "the aircraft has landed, and stands"},
      {"duration", true, "1288 s in the air and on the runway, at most 1800"},
      {"targets", true, "3 of 3 elements collected as finely as they were ordered"},
      {"survival", true,
       "survived the air defence with a probability of 0.991, at least 0.950; tracked for 41 s"},
      {"clearance", true, "251 m above ground at the lowest place of the way, at least 200"},
      {"well clear", true,
       "1204 m beside and 88 m above or below at the closest, at least 671 or 137"},
      {"no stall", true, "it never stalled"},
      {"landing", true, "touched down 62 m from the aiming point, at most 400"},
      {"fuel", true, "63.9 kg left, at least 20.0"}};
  record.tracked_s = 41;
  record.survival = 0.991;
  record.ground = ground_around(record, 180, hills);
  return record;
}

}  // namespace reconnaissance::test
