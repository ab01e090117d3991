#pragma once

#include <algorithm>
#include <concepts>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <vector>

namespace skein::navigation {

/// What find_cheapest_path asks of a graph. `lower_bound` must never exceed the true cost from a
/// node to the goal, and must not fall along an edge by more than that edge costs (be consistent).
template <class Graph>
concept SearchGraph = requires(const Graph& graph, int node) {
  { graph.node_count() } -> std::convertible_to<int>;
  { graph.lower_bound(node) } -> std::convertible_to<double>;
  graph.for_each_edge(node, [](int /*to*/, double /*cost*/) {});
};

struct FoundPath {
  std::vector<int> nodes;  ///< From start to goal, both included.
  double cost;
};

enum class SearchEnd { Found, Unreachable, Stopped };

struct SearchResult {
  SearchEnd end;
  FoundPath path;        ///< Empty unless Found.
  std::size_t expanded;  ///< Nodes whose edges were looked at.
};

/// A* with a binary heap: the cheapest path, or the proof that there is none. Costs are not
/// negative. `stop` is asked every 256 expansions.
template <SearchGraph Graph>
SearchResult find_cheapest_path(const Graph& graph, int start, int goal,
                                const std::function<bool()>& stop) {
  struct Open {
    double estimate;
    double cost;
    int node;
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : cost < other.cost;
    }
  };
  const auto count = static_cast<std::size_t>(graph.node_count());
  std::vector<double> cost(count, std::numeric_limits<double>::infinity());
  std::vector<int> parent(count, -1);
  std::vector<bool> closed(count, false);
  std::priority_queue<Open> open;
  SearchResult result{SearchEnd::Unreachable, {{}, 0}, 0};

  const auto at = [](int node) { return static_cast<std::size_t>(node); };
  cost[at(start)] = 0;
  open.push({graph.lower_bound(start), 0, start});
  while (!open.empty()) {
    const Open best = open.top();
    open.pop();
    if (closed[at(best.node)]) continue;
    if (best.node == goal) {
      result.end = SearchEnd::Found;
      result.path.cost = best.cost;
      for (int node = goal; node != -1; node = parent[at(node)]) result.path.nodes.push_back(node);
      std::reverse(result.path.nodes.begin(), result.path.nodes.end());
      return result;
    }
    if (result.expanded % 256 == 0 && stop && stop()) {
      result.end = SearchEnd::Stopped;
      return result;
    }
    closed[at(best.node)] = true;
    ++result.expanded;
    graph.for_each_edge(best.node, [&](int to, double edge_cost) {
      const double candidate = best.cost + edge_cost;
      if (closed[at(to)] || candidate >= cost[at(to)]) return;
      cost[at(to)] = candidate;
      parent[at(to)] = best.node;
      open.push({candidate + graph.lower_bound(to), candidate, to});
    });
  }
  return result;
}

}  // namespace skein::navigation
