#pragma once

#include <array>
#include <set>
#include <string>
#include <vector>

#include "navigation/planners/planning_scene.hpp"
#include "navigation/planners/taut_path.hpp"

namespace skein::navigation {

/// The planning grid as a graph for find_cheapest_path: moves to 32 neighbours along the flight
/// surface, and two further nodes for start and goal themselves, which lie between grid nodes. No
/// move passes a closed node or cuts a zone's corner.
class SurfaceGraph {
 public:
  SurfaceGraph(const PlanningScene& scene, Berth berth);

  int start() const { return scene_.grid().size(); }
  int goal() const { return scene_.grid().size() + 1; }
  int node_count() const { return scene_.grid().size() + 2; }
  GroundPoint point(int node) const;

  /// The straight distance: what threats cost is never negative.
  double lower_bound(int node) const {
    return distance_m(point(node), on_map(scene_.problem().goal));
  }

  template <class Visit>
  void for_each_edge(int node, Visit&& visit) const {
    const GroundPoint from = point(node);
    if (node < scene_.grid().size()) {
      for (const Move& move : moves_) {
        const int to = follow(node, move);
        if (to >= 0) visit(to, cost(from, to, rate(node)));
      }
    }
    for (const int end : {start(), goal()}) {
      for (const int other : around_[end == goal()]) {
        if (node == end && other != end) visit(other, cost(from, other, rate(node)));
        if (node == other && node != end) visit(end, cost(from, end, rate(node)));
      }
    }
  }

  /// Why nothing leads out of the smaller of the two regions, around the start and around the goal,
  /// that a search has found to be apart.
  std::string explain_separation() const;

 private:
  struct Move {
    int rows;
    int columns;
    std::vector<std::array<int, 2>> passed;  ///< Nodes of the cells that it crosses.
  };
  struct Region {
    int nodes = 0;
    std::set<std::string> zones;
    bool ground = false;
  };

  int follow(int node, const Move& move) const;
  bool blocked_by_zone(int node) const { return near_zone_[static_cast<std::size_t>(node)] == 2; }
  double rate(int node) const;
  double cost(const GroundPoint& from, int to, double rate_from) const;
  std::vector<int> nodes_around(int end) const;
  Region region_around(int end) const;

  const PlanningScene& scene_;
  Berth berth_;
  std::vector<Move> moves_;
  std::vector<char> near_zone_;             ///< 0 far from all, 1 near one, 2 inside one.
  std::array<std::vector<int>, 2> around_;  ///< Neighbours of start and of goal.
  double end_rates_[2] = {0, 0};
  bool risky_;
};

}  // namespace skein::navigation
