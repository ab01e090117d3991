#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "planning/collection_problem.hpp"
#include "random.hpp"

// Seeded problems of collection: 40 × 40 km, 60 m/s, turns of 636 m, two radar sites.
namespace reconnaissance {

/// On courses that divide the circle evenly.
inline std::vector<CollectionPass> passes_over(double north_m, double east_m, int courses) {
  std::vector<CollectionPass> passes;
  for (int i = 0; i < courses; ++i) {
    const RoutePose pose{north_m, east_m, 2 * std::numbers::pi * i / courses};
    passes.push_back({pose, pose, {}});
  }
  return passes;
}

struct Scene {
  std::vector<CollectionTask> tasks;
  std::vector<RoutePose> sites;
  RoutePose home{0, 0, 0};
  /// Time, fuel and hazard of a leg have nothing to do with each other or with its length.
  bool arbitrary = false;

  static constexpr double kSpeed_m_s = 60;
  static constexpr double kRadius_m = 636;

  /// Flown straight for what concerns the sites.
  FlightCost leg(const RoutePose& from, const RoutePose& to) const {
    if (arbitrary) {
      Random random(static_cast<std::uint64_t>(
          std::abs(1e3 * (from.north_m + 2 * from.east_m + 1e4 * from.course_rad) +
                   7e3 * (to.north_m + 3 * to.east_m + 1e4 * to.course_rad))));
      const double seconds = 1000 * random.uniform();
      const double fuel_kg = 10 * random.uniform();
      return {seconds, fuel_kg, 0.02 * random.uniform()};
    }
    constexpr double kHazard_s = 4e-4;
    constexpr double kReach_m = 7000;
    FlightCost cost;
    cost.seconds = dubins_length_m(from, to, kRadius_m) / kSpeed_m_s;
    cost.fuel_kg = 0.012 * cost.seconds;
    constexpr int kSamples = 40;
    for (int i = 0; i < kSamples; ++i) {
      const double part = (i + 0.5) / kSamples;
      const double north = from.north_m + part * (to.north_m - from.north_m);
      const double east = from.east_m + part * (to.east_m - from.east_m);
      for (const RoutePose& site : sites) {
        if (std::hypot(north - site.north_m, east - site.east_m) < kReach_m) {
          cost.hazard += kHazard_s * cost.seconds / kSamples;
        }
      }
    }
    return cost;
  }

  CollectionProblem problem(const FlightLimits& limits) const {
    return {home, home, tasks,
            [this](const RoutePose& from, const RoutePose& to) { return leg(from, to); }, limits};
  }
};

/// One task in three is a line; values from 1 to 10.
inline Scene random_scene(std::uint64_t seed, int tasks, int courses) {
  Random random(seed);
  const auto place = [&] {
    const double north = 40'000 * (random.uniform() - 0.5);
    return RoutePose{north, 40'000 * (random.uniform() - 0.5), 0};
  };
  Scene scene;
  for (int i = 0; i < tasks; ++i) {
    CollectionTask task;
    task.value = 1 + std::floor(10 * random.uniform());
    const RoutePose at = place();
    if (i % 3 == 2) {
      const double course = 2 * std::numbers::pi * random.uniform();
      const double back = course + std::numbers::pi;
      const double north = at.north_m + 3000 * std::cos(course);
      const double east = at.east_m + 3000 * std::sin(course);
      task.passes = {{{at.north_m, at.east_m, course}, {north, east, course}, {50, 0.6, 0}},
                     {{north, east, back}, {at.north_m, at.east_m, back}, {50, 0.6, 0}}};
    } else {
      task.passes = passes_over(at.north_m, at.east_m, courses);
    }
    scene.tasks.push_back(task);
  }
  scene.sites = {place(), place()};
  return scene;
}

/// What a plan claims must be what its legs take.
inline bool adds_up(const Scene& scene, const FlightLimits& limits, const CollectionTour& plan) {
  FlightCost cost;
  double value = 0;
  RoutePose at = scene.home;
  std::vector<bool> done(scene.tasks.size());
  for (const auto& [task, pass] : plan.collections) {
    if (done[task]) return false;
    done[task] = true;
    const CollectionPass& flown = scene.tasks[task].passes[pass];
    cost += scene.leg(at, flown.begin) + flown.cost;
    at = flown.end;
    value += scene.tasks[task].value;
  }
  cost += scene.leg(at, scene.home);
  const auto same = [](double a, double b) { return std::abs(a - b) < 1e-6; };
  return same(value, plan.value) && same(cost.seconds, plan.cost.seconds) &&
         same(cost.fuel_kg, plan.cost.fuel_kg) && same(cost.hazard, plan.cost.hazard) &&
         plan.feasible == covers(cost, limits.most());
}

}  // namespace reconnaissance
