#include <catch2/catch.hpp>

#include "view/connection_graph.hpp"

using namespace skein::view;

TEST_CASE("A graph that stays as it is has no change") {
  const Graph graph{{{"t", {"a"}}}, {{"t", {"b"}}}, {{"s", {"a", "b"}}}};
  CHECK(change(graph, graph).empty());
  CHECK(change({}, {}).empty());
}

TEST_CASE("Compared with an empty one, all of a graph is new") {
  const Graph graph{{{"t", {"a"}}}, {{"u", {"b"}}}, {{"s", {"a"}}}};
  const auto found = change({}, graph);
  CHECK(found.changed.publishers == graph.publishers);
  CHECK(found.changed.subscribers == graph.subscribers);
  CHECK(found.changed.providers == graph.providers);
  CHECK(found.removed_topics.empty());
  CHECK(found.removed_services.empty());
}

TEST_CASE("Only those with other ends than before are told") {
  const Graph before{{{"t", {"a"}}, {"u", {"a"}}}, {}, {{"s", {"a"}}}};
  const Graph after{{{"t", {"a", "b"}}, {"u", {"a"}}}, {}, {{"s", {"a"}}}};
  const auto found = change(before, after);
  CHECK(found.changed.publishers == Graph::Ends{{"t", {"a", "b"}}});
  CHECK(found.changed.providers.empty());
}

TEST_CASE("A topic is removed when it has neither publishers nor subscribers any more") {
  const Graph before{{{"t", {"a"}}, {"u", {"a"}}}, {{"t", {"b"}}}, {{"s", {"a"}}}};
  const auto left = change(before, {{}, {{"t", {"b"}}}, {{"s", {"a"}}}});
  CHECK(left.changed.publishers == Graph::Ends{{"t", {}}});
  CHECK(left.removed_topics == std::vector<std::string>{"u"});
  const auto gone = change(before, {});
  CHECK(gone.changed.publishers.empty());
  CHECK(gone.changed.subscribers.empty());
  CHECK(gone.removed_topics == std::vector<std::string>{"t", "u"});
  CHECK(gone.removed_services == std::vector<std::string>{"s"});
}
