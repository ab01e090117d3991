#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace skein::view {

/// Who of a mission publishes, subscribes and provides what, by names.
struct Graph {
  using Ends = std::map<std::string, std::set<std::string>>;

  Ends publishers;   ///< Of each topic.
  Ends subscribers;  ///< Of each topic.
  Ends providers;    ///< Of each service.
};

/// What has become of a graph.
struct GraphChange {
  Graph changed;  ///< Those whose ends differ from before, which may have none now.
  std::vector<std::string> removed_topics;
  std::vector<std::string> removed_services;

  bool empty() const;
};

GraphChange change(const Graph& before, const Graph& after);

}  // namespace skein::view
