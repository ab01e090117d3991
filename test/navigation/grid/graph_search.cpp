#include "navigation/grid/graph_search.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace skein::navigation::grid;

namespace {

/// A small grid whose nodes have prices: a move costs its length times the mean of two prices.
struct PricedGrid {
  int side;
  std::vector<double> price;  ///< 0 for a wall.
  int goal;

  int node_count() const { return side * side; }
  double lower_bound(int node) const {
    return std::hypot(node / side - goal / side, node % side - goal % side);
  }
  template <class Visit>
  void for_each_edge(int node, Visit&& visit) const {
    for (int rows = -1; rows <= 1; ++rows) {
      for (int columns = -1; columns <= 1; ++columns) {
        const int row = node / side + rows;
        const int column = node % side + columns;
        if ((rows == 0 && columns == 0) || row < 0 || column < 0 || row >= side || column >= side) {
          continue;
        }
        const int to = row * side + column;
        if (at(to) == 0 || at(node) == 0) continue;
        visit(to, std::hypot(rows, columns) * (at(node) + at(to)) / 2);
      }
    }
  }
  double at(int node) const { return price[static_cast<std::size_t>(node)]; }
};

PricedGrid make_grid(std::mt19937& random) {
  std::uniform_int_distribution<int> side(2, 12);
  std::uniform_real_distribution<double> price(1, 6), share(0, 1);
  PricedGrid grid{side(random), {}, 0};
  grid.goal = std::uniform_int_distribution<int>(0, grid.side * grid.side - 1)(random);
  for (int i = 0; i < grid.side * grid.side; ++i) {
    grid.price.push_back(share(random) < 0.3 ? 0 : price(random));
  }
  return grid;
}

/// Shortest paths by relaxing all edges until nothing changes: slow, and hard to get wrong.
double cheapest_by_force(const PricedGrid& grid, int start) {
  std::vector<double> cost(static_cast<std::size_t>(grid.node_count()), INFINITY);
  cost[static_cast<std::size_t>(start)] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int node = 0; node < grid.node_count(); ++node) {
      grid.for_each_edge(node, [&](int to, double edge) {
        double& best = cost[static_cast<std::size_t>(to)];
        const double candidate = cost[static_cast<std::size_t>(node)] + edge;
        if (candidate < best) {
          best = candidate;
          changed = true;
        }
      });
    }
  }
  return cost[static_cast<std::size_t>(grid.goal)];
}

}  // namespace

TEST_CASE(
    "The path found is as cheap as any, and there is none only where brute force finds none") {
  std::mt19937 random(5);
  SearchMemory memory;  // Handed on, also between graphs of different sizes.
  int unreachable = 0;
  for (int round = 0; round < 500; ++round) {
    const PricedGrid grid = make_grid(random);
    const int start = std::uniform_int_distribution<int>(0, grid.node_count() - 1)(random);
    const double expected = cheapest_by_force(grid, start);
    const SearchResult found = find_cheapest_path(grid, start, grid.goal, {}, memory);
    if (std::isinf(expected)) {
      ++unreachable;
      REQUIRE(found.end == SearchEnd::Unreachable);
      continue;
    }
    REQUIRE(found.end == SearchEnd::Found);
    REQUIRE(found.path.cost == Approx(expected));
    REQUIRE(found.path.nodes.front() == start);
    REQUIRE(found.path.nodes.back() == grid.goal);
    double walked = 0;
    for (std::size_t i = 1; i < found.path.nodes.size(); ++i) {
      double edge = INFINITY;
      grid.for_each_edge(found.path.nodes[i - 1], [&](int to, double cost) {
        if (to == found.path.nodes[i]) edge = cost;
      });
      walked += edge;
    }
    REQUIRE(walked == Approx(expected));
  }
  CHECK(unreachable > 20);
}

TEST_CASE("A search ends when it is told to stop") {
  const PricedGrid grid{200, std::vector<double>(200 * 200, 3.0), 200 * 200 - 1};
  int asked = 0;
  const SearchResult found = find_cheapest_path(grid, 0, grid.goal, [&] { return ++asked > 1; });
  CHECK(found.end == SearchEnd::Stopped);
  CHECK(found.expanded < 1000);
  CHECK(find_cheapest_path(grid, 0, grid.goal, {}).end == SearchEnd::Found);
}
