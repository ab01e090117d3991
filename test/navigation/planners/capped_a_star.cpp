#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <queue>

#include "navigation/threats/radar_exposure.hpp"
#include "skein/error.hpp"
#include "test/navigation/flat_crossing.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::NoRoute;
using AE_navigator::Route;

namespace {

FlatCrossing two_radars() {
  FlatCrossing crossing;
  crossing.problem.radar_sites.push_back({"S", {50000, 65000}, 20, 5000, 1});
  return crossing;
}

constexpr double kFine_m = 400;

/// The length of the shortest path under the cap over the nodes of a fine grid: labels in the order
/// of their length, of which a node keeps those that are less exposed, by a three-hundredth of the
/// cap, than all before.
class FineGrid {
 public:
  explicit FineGrid(const AE_navigator::Problem& problem) : problem_(problem) {
    for (int node = 0; node < kRows * kColumns; ++node) add_edges(node);
  }

  double shortest_m(double cap_m) const {
    const int goal = number(kRows / 2, kColumns - 1);
    const std::vector<double> least = least_exposures(goal);
    std::vector<double> kept(least.size(), INFINITY);
    std::priority_queue<Label> open;
    open.push({0, 0, number(kRows / 2, 0)});
    while (!open.empty()) {
      const Label label = open.top();
      open.pop();
      if (label.exposure_m > kept[at(label.node)] - cap_m / 300) continue;
      kept[at(label.node)] = label.exposure_m;
      if (label.node == goal) return label.length_m;
      for (const Edge& edge : edges_[at(label.node)]) {
        const double sum = label.exposure_m + edge.exposure_m;
        if (sum + least[at(edge.to)] > cap_m || sum >= kept[at(edge.to)]) continue;
        open.push({label.length_m + edge.length_m, sum, edge.to});
      }
    }
    return INFINITY;
  }

 private:
  static constexpr int kRows = 51;
  static constexpr int kColumns = 101;
  struct Edge {
    int to;
    double length_m;
    double exposure_m;
  };
  struct Label {
    double length_m;
    double exposure_m;
    int node;
    bool operator<(const Label& other) const { return length_m > other.length_m; }
  };

  static std::size_t at(int node) { return static_cast<std::size_t>(node); }
  static int number(int row, int column) { return row * kColumns + column; }

  double rate(double row, double column) const {
    const double north = 55000 + (row - kRows / 2) * kFine_m;
    const double east = 35000 + column * kFine_m;
    double sum = 0;
    for (const auto& radar : problem_.radar_sites) {
      const double ground = std::hypot(north - radar.site.north_m, east - radar.site.east_m);
      sum += exposure_rate(radar.range_m, radar.strength, std::hypot(ground, 80));
    }
    return sum;
  }

  /// To all nodes up to three away that no nearer one lies before.
  void add_edges(int from) {
    std::vector<Edge>& edges = edges_.emplace_back();
    const int row = from / kColumns;
    const int column = from % kColumns;
    for (int i = 0; i < 49; ++i) {
      const int rows = i / 7 - 3;
      const int columns = i % 7 - 3;
      if (std::gcd(rows, columns) != 1 || row + rows < 0 || row + rows >= kRows ||
          column + columns < 0 || column + columns >= kColumns) {
        continue;
      }
      const double length = kFine_m * std::hypot(rows, columns);
      const double mean = (rate(row, column) + 4 * rate(row + rows / 2.0, column + columns / 2.0) +
                           rate(row + rows, column + columns)) /
                          6;
      edges.push_back({number(row + rows, column + columns), length, length * mean});
    }
  }

  /// Dijkstra by exposure.
  std::vector<double> least_exposures(int from) const {
    std::vector<double> least(at(kRows * kColumns), INFINITY);
    std::priority_queue<Label> open;
    open.push({0, 0, from});
    while (!open.empty()) {
      const Label label = open.top();  // Its length is an exposure here.
      open.pop();
      if (label.length_m >= least[at(label.node)]) continue;
      least[at(label.node)] = label.length_m;
      for (const Edge& edge : edges_[at(label.node)]) {
        const double sum = label.length_m + edge.exposure_m;
        if (sum < least[at(edge.to)]) open.push({sum, 0, edge.to});
      }
    }
    return least;
  }

  const AE_navigator::Problem& problem_;
  std::vector<std::vector<Edge>> edges_;
};

Route plan(const FlatCrossing& crossing, double cap_m) {
  PlannerOptions options;
  options.exposure_cap_m = cap_m;
  options.grid_spacing_m = 2 * kFine_m;
  return make_planner("CappedAStar", crossing.terrains, options)->plan(crossing.problem);
}

}  // namespace

TEST_CASE("A route under a cap is nearly as short as the exact one on a grid twice as fine") {
  const FlatCrossing crossing = two_radars();
  const FineGrid exact(crossing.problem);
  double shorter = INFINITY;
  for (const double cap_m : {8000.0, 20000.0, 60000.0}) {
    const Route route = plan(crossing, cap_m);
    INFO("cap " << cap_m << " m, exposure " << route.radar_exposure << " m");
    CHECK(route.radar_exposure <= cap_m);
    CHECK(route.planner == "CappedAStar");
    CHECK(violations(crossing.problem, route, crossing.ground()) == "");
    CHECK(route.length_m < 1.04 * exact.shortest_m(cap_m));
    CHECK(route.length_m > 0.97 * exact.shortest_m(cap_m));
    CHECK(route.length_m < shorter);
    shorter = route.length_m;
  }
}

TEST_CASE("Without threats or without a cap the route under a cap is the shortest") {
  FlatCrossing crossing = two_radars();
  crossing.problem.exposure_weight = 0;
  PlannerOptions options;
  options.grid_spacing_m = 2 * kFine_m;
  const Route shortest = make_planner("AStar", crossing.terrains, options)->plan(crossing.problem);
  crossing.problem.exposure_weight = 1;
  CHECK(plan(crossing, INFINITY).waypoints == shortest.waypoints);
  crossing.problem.radar_sites.clear();
  CHECK(plan(crossing, 0).waypoints == shortest.waypoints);
}

TEST_CASE("The cap of the problem and that of the planner both hold") {
  FlatCrossing crossing = two_radars();
  const Route capped = plan(crossing, 8000);
  crossing.problem.exposure_cap_m = 8000;
  CHECK(plan(crossing, INFINITY).waypoints == capped.waypoints);
  CHECK(plan(crossing, 60000).waypoints == capped.waypoints);
  crossing.problem.exposure_cap_m = 60000;
  CHECK(plan(crossing, 8000).waypoints == capped.waypoints);
}

TEST_CASE("A cap that no route keeps is refused with the least exposure that was found") {
  const FlatCrossing crossing = two_radars();
  const NoRoute refusal = refusal_of([&] { plan(crossing, 1); });
  CHECK_THAT(refusal.reason, Catch::Contains("the cap is 1 m"));
  CHECK_FALSE(refusal.proven);
  CHECK_THROWS_AS(plan(crossing, -1), skein::InvalidArgument);
  CHECK_THROWS_AS(plan(crossing, NAN), skein::InvalidArgument);
}
