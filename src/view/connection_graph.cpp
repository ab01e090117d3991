#include "view/connection_graph.hpp"

namespace skein::view {
namespace {

Graph::Ends changed(const Graph::Ends& before, const Graph::Ends& after) {
  Graph::Ends result;
  for (const auto& [name, ends] : after) {
    const auto old = before.find(name);
    if (old == before.end() || old->second != ends) result.emplace(name, ends);
  }
  for (const auto& [name, ends] : before) {
    if (!after.contains(name)) result.emplace(name, std::set<std::string>{});
  }
  return result;
}

/// Takes those without ends whose name `stands` nowhere any more.
template <class Stands>
void take_removed(Graph::Ends& ends, const Stands& stands, std::set<std::string>& removed) {
  std::erase_if(ends, [&](const auto& entry) {
    if (!entry.second.empty() || stands(entry.first)) return false;
    removed.insert(entry.first);
    return true;
  });
}

}  // namespace

bool GraphChange::empty() const {
  return changed.publishers.empty() && changed.subscribers.empty() && changed.providers.empty() &&
         removed_topics.empty() && removed_services.empty();
}

GraphChange change(const Graph& before, const Graph& after) {
  GraphChange result{
      {changed(before.publishers, after.publishers), changed(before.subscribers, after.subscribers),
       changed(before.providers, after.providers)},
      {},
      {}};
  std::set<std::string> topics;
  const auto topic_stands = [&](const std::string& name) {
    return after.publishers.contains(name) || after.subscribers.contains(name);
  };
  take_removed(result.changed.publishers, topic_stands, topics);
  take_removed(result.changed.subscribers, topic_stands, topics);
  result.removed_topics.assign(topics.begin(), topics.end());
  std::set<std::string> services;
  take_removed(
      result.changed.providers,
      [&](const std::string& name) { return after.providers.contains(name); }, services);
  result.removed_services.assign(services.begin(), services.end());
  return result;
}

}  // namespace skein::view
