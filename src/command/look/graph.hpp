#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "domain_picture.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::command {

/// Who speaks to whom, as a drawing needs it.
struct Graph {
  struct Node {
    std::string id;      ///< `p0`, `t0`: safe in every notation.
    std::string system;  ///< The frame in which it stands; empty for topics.
    std::string label;   ///< Lines, with `\n` between them.
    bool topic = false;
  };
  struct Edge {
    std::string from;
    std::string to;
    std::string label;
  };
  std::vector<Node> nodes;
  std::vector<Edge> edges;
};

/// What a picture does not show: what went on since an earlier one, and how long calls took.
struct Traffic {
  DomainPicture before{};
  double seconds = 0;  ///< Between both.
  std::vector<introspection::ServiceStatistics> services{};
};

/// Peers with what they provide and own; an edge for each connection, from the caller to the
/// provider, with its transport, its calls per second, and how long the operation runs that was
/// called most; topics with an edge from each publisher, with its values per second, and to each
/// subscriber that may hear it. Text that peers sent is printable.
Graph graph_of(const DomainPicture& picture, const Traffic& traffic = {});

std::string to_dot(const Graph& graph);
std::string to_mermaid(const Graph& graph);
nlohmann::ordered_json to_json(const Graph& graph);

}  // namespace skein::command
