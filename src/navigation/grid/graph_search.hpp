#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

namespace skein::navigation::grid {

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

/// What a search keeps of the nodes. Handed from one search to the next,
/// it makes each pay for the nodes that it visits alone. For one search at a time.
class SearchMemory {
 public:
  struct Node {
    double cost = 0;
    int parent = -1;
    std::uint32_t search = 0;  ///< That reached it last.
    bool closed = false;
  };

  void begin(int node_count) {
    nodes_.resize(static_cast<std::size_t>(node_count));
    ++search_;
  }
  Node& operator[](int node) { return nodes_[static_cast<std::size_t>(node)]; }
  bool reached(const Node& node) const { return node.search == search_; }
  void reach(int node, double cost, int parent) { (*this)[node] = {cost, parent, search_, false}; }

  std::vector<int> path_to(int node) {
    std::vector<int> nodes;
    for (; node != -1; node = (*this)[node].parent) nodes.push_back(node);
    std::reverse(nodes.begin(), nodes.end());
    return nodes;
  }

 private:
  std::vector<Node> nodes_;
  std::uint32_t search_ = 0;
};

/// A* with a binary heap: the cheapest path, or the proof that there is none. Costs are not
/// negative. `stop` is asked every 256 expansions.
template <SearchGraph Graph>
SearchResult find_cheapest_path(const Graph& graph, int start, int goal,
                                const std::function<bool()>& stop, SearchMemory& memory) {
  struct Open {
    double estimate;
    double cost;
    int node;
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : cost < other.cost;
    }
  };
  std::priority_queue<Open> open;
  SearchResult result{SearchEnd::Unreachable, {{}, 0}, 0};

  memory.begin(graph.node_count());
  memory.reach(start, 0, -1);
  open.push({graph.lower_bound(start), 0, start});
  while (!open.empty()) {
    const Open best = open.top();
    open.pop();
    SearchMemory::Node& node = memory[best.node];
    if (node.closed) continue;
    if (best.node == goal)
      return {SearchEnd::Found, {memory.path_to(goal), best.cost}, result.expanded};
    if (result.expanded % 256 == 0 && stop && stop()) {
      result.end = SearchEnd::Stopped;
      return result;
    }
    node.closed = true;
    ++result.expanded;
    graph.for_each_edge(best.node, [&](int to, double edge_cost) {
      const double candidate = best.cost + edge_cost;
      const SearchMemory::Node& next = memory[to];
      if (memory.reached(next) && (next.closed || candidate >= next.cost)) return;
      memory.reach(to, candidate, best.node);
      open.push({candidate + graph.lower_bound(to), candidate, to});
    });
  }
  return result;
}

template <SearchGraph Graph>
SearchResult find_cheapest_path(const Graph& graph, int start, int goal,
                                const std::function<bool()>& stop) {
  SearchMemory memory;
  return find_cheapest_path(graph, start, goal, stop, memory);
}

}  // namespace skein::navigation::grid
