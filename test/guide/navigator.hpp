#pragma once

#include "skein/head.hpp"
#include "survey.idl.hpp"

/// A CSP: rows, one beside the other.
class Rows : public survey::IPlanner {
 public:
  survey::Track plan(const survey::Area& area) override {
    const double area_m2 = area.length_m * area.width_m;
    return {"Rows", area_m2 / 10, area_m2};
  }
};

/// A CSP: from the middle outwards. It takes no time, and a longer track.
class Spiral : public survey::IPlanner {
 public:
  survey::Track plan(const survey::Area& area) override {
    const double area_m2 = area.length_m * area.width_m;
    return {"Spiral", area_m2 / 8, area_m2};
  }
};

/// A CSP that promises much and leaves out every other row.
class Careless : public survey::IPlanner {
 public:
  survey::Track plan(const survey::Area& area) override {
    const double area_m2 = area.length_m * area.width_m;
    return {"Careless", area_m2 / 20, area_m2 / 2};
  }
};

/// The Body: says what the task is and how a result is judged. It holds no algorithm.
class Navigator : public survey::INavigator {
 public:
  explicit Navigator(skein::Head& head) : head_(head) {}

  survey::Track plan(const survey::Area& area) override {
    const double area_m2 = area.length_m * area.width_m;
    skein::Task<survey::IPlanner, survey::Track> task;
    task.request = "track";
    task.features = {{"area_m2", area_m2}};
    task.run = [&](survey::IPlanner::Proxy& planner, skein::Duration) {
      return planner.plan(area);
    };
    task.evaluate.check("covers the area", [&](const survey::Track& track) {
      return track.covered_m2 >= area_m2 ? std::nullopt
                                         : std::optional<std::string>("it leaves out a part");
    });
    task.quality = [&](const survey::Track& track) { return area_m2 / 10 / track.length_m; };
    try {
      return head_.perform(task);
    } catch (const skein::NoneAccepted& refusal) {
      throw survey::NoTrack(refusal.what());
    }
  }

 private:
  skein::Head& head_;
};
