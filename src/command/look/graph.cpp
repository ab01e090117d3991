#include "graph.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "command/commands.hpp"
#include "command/print/figures.hpp"
#include "command/print/graphviz.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "core/printable.hpp"
#include "core/system/whole_file.hpp"
#include "entity/entity_access.hpp"
#include "entity/statistics_topic.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

/// Seconds, for rates. Services tell their statistics once a second.
constexpr double kBetweenLooks = 1;

std::string system_of(const PeerPicture& peer) { return peer.name.substr(0, peer.name.find('/')); }

std::string label_of(const PeerPicture& peer) {
  const std::string name = peer.name.find('/') == std::string::npos
                               ? peer.name
                               : peer.name.substr(peer.name.find('/') + 1);
  std::string label = printable(name);
  for (const auto& service : peer.services) {
    label += "\n" + (service->owner.empty() ? "" : "CSP " + printable(service->entity) + ": ") +
             printable(service->service);
  }
  return peer.process ? label : label + "\n(does not answer)";
}

/// The ids of peers, and of the providers that they have.
struct Index {
  std::map<Guid, std::string> peers;
  std::map<Guid, std::string> providers;
};

Index add_peers(const DomainPicture& picture, Graph& graph) {
  Index index;
  for (const PeerPicture& peer : picture) {
    const std::string id = "p" + std::to_string(graph.nodes.size());
    graph.nodes.push_back({id, printable(system_of(peer)), label_of(peer)});
    index.peers[peer.participant] = id;
    for (const auto& service : peer.services) index.providers[Guid{service->provider}] = id;
  }
  return index;
}

/// Of the operation that was called most; empty where the provider tells nothing.
std::string latency_of(const Guid& provider, const Traffic& traffic) {
  const auto service =
      std::ranges::find_if(traffic.services, [&](const introspection::ServiceStatistics& each) {
        return Guid{each.provider} == provider;
      });
  if (service == traffic.services.end() || service->operations.empty()) return "";
  const auto& most = *std::ranges::max_element(
      service->operations, {}, [](const auto& operation) { return operation.ran.count; });
  if (most.ran.count == 0) return "";
  return "\n" + printable(most.name) + " runs " + short_time(most.ran.p50) + ", p99 " +
         short_time(most.ran.p99);
}

/// `, 12/s`; empty where there is no earlier count.
std::string rate_of(std::optional<std::uint64_t> before, std::uint64_t now,
                    const Traffic& traffic) {
  if (!before || now < *before || traffic.seconds <= 0) return "";
  return short_number(static_cast<double>(now - *before) / traffic.seconds) + "/s";
}

/// From a peer to a provider, over a transport: several connections are drawn once.
using ConnectionKey = std::tuple<Guid, Guid, std::string, std::string>;

std::map<ConnectionKey, std::uint64_t> calls_in(const DomainPicture& picture) {
  std::map<ConnectionKey, std::uint64_t> calls;
  for (const PeerPicture& peer : picture) {
    for (const inspection::Connection& connection : peer.connections) {
      calls[{peer.participant, Guid{connection.provider}, connection.service,
             connection.transport}] += connection.calls;
    }
  }
  return calls;
}

template <class Key>
std::optional<std::uint64_t> found_in(const std::map<Key, std::uint64_t>& counts, const Key& key) {
  const auto found = counts.find(key);
  return found == counts.end() ? std::nullopt : std::optional(found->second);
}

void add_connections(const DomainPicture& picture, const Traffic& traffic, const Index& index,
                     Graph& graph) {
  const auto before = calls_in(traffic.before);
  for (const auto& [key, calls] : calls_in(picture)) {
    const auto& [caller, provider, service, transport] = key;
    const auto to = index.providers.find(provider);
    if (to == index.providers.end()) continue;
    const std::string rate = rate_of(found_in(before, key), calls, traffic);
    graph.edges.push_back({index.peers.at(caller), to->second,
                           printable(service) + "\n" + printable(transport) +
                               (rate.empty() ? "" : ", " + rate) + latency_of(provider, traffic)});
  }
}

/// A topic of a system is another one than that of the same name elsewhere.
using TopicKey = std::pair<std::string, std::string>;

std::vector<TopicKey> keys_of(const inspection::TopicEndpoint& endpoint, const PeerPicture& peer) {
  std::vector<TopicKey> keys;
  for (const std::string& system : endpoint.systems) keys.emplace_back(system, endpoint.name);
  if (keys.empty()) keys.emplace_back(system_of(peer), endpoint.name);
  return keys;
}

/// Values that a peer has published on a topic.
std::map<std::pair<Guid, std::string>, std::uint64_t> published_in(const DomainPicture& picture) {
  std::map<std::pair<Guid, std::string>, std::uint64_t> published;
  for (const PeerPicture& peer : picture) {
    for (const inspection::TopicEndpoint& endpoint : peer.topics) {
      if (endpoint.publishes) published[{peer.participant, endpoint.name}] += endpoint.samples;
    }
  }
  return published;
}

void add_topics(const DomainPicture& picture, const Traffic& traffic, const Index& index,
                Graph& graph) {
  const auto before = published_in(traffic.before);
  const auto now = published_in(picture);
  std::map<TopicKey, std::string> ids;
  for (const PeerPicture& peer : picture) {
    for (const inspection::TopicEndpoint& endpoint : peer.topics) {
      for (const TopicKey& key : keys_of(endpoint, peer)) {
        std::string& id = ids[key];
        if (id.empty()) {
          id = "t" + std::to_string(ids.size() - 1);
          graph.nodes.push_back({id, printable(key.first),
                                 printable(endpoint.name) + "\n" + printable(endpoint.type), true});
        }
        const std::string& own = index.peers.at(peer.participant);
        if (!endpoint.publishes) {
          graph.edges.push_back({id, own, ""});
          continue;
        }
        const auto source = std::pair(peer.participant, endpoint.name);
        graph.edges.push_back(
            {own, id, rate_of(found_in(before, source), now.at(source), traffic)});
      }
    }
  }
}

std::set<std::string> systems_of(const Graph& graph) {
  std::set<std::string> systems;
  for (const Graph::Node& node : graph.nodes) systems.insert(node.system);
  return systems;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

std::string dot_text(const std::string& text) {
  return "\"" + replaced(replaced(replaced(text, "\\", "\\\\"), "\"", "\\\""), "\n", "\\n") + "\"";
}

/// Mermaid reads HTML in its labels.
std::string mermaid_text(std::string text) {
  text = replaced(std::move(text), "&", "#amp;");
  for (const auto& [character, name] :
       {std::pair("\"", "#quot;"), {"<", "#lt;"}, {">", "#gt;"}, {"`", "#96;"}})
    text = replaced(std::move(text), character, name);
  return "\"" + replaced(std::move(text), "\n", "<br>") + "\"";
}

std::string picture_of(const Graph& graph, const std::string& format) try {
  return run_dot(format, to_dot(graph));
} catch (const Unavailable& error) {  // not of the domain
  throw WriteFailed(error.what());
}

}  // namespace

Graph graph_of(const DomainPicture& picture, const Traffic& traffic) {
  Graph graph;
  const Index index = add_peers(picture, graph);
  add_connections(picture, traffic, index, graph);
  add_topics(picture, traffic, index, graph);
  return graph;
}

std::string to_dot(const Graph& graph) {
  std::string text = "digraph skein {\n  rankdir=LR;\n  node [shape=box];\n";
  std::size_t number = 0;
  for (const std::string& system : systems_of(graph)) {
    text += "  subgraph cluster_" + std::to_string(number++) + " {\n    label=" + dot_text(system) +
            ";\n";
    for (const Graph::Node& node : graph.nodes) {
      if (node.system != system) continue;
      text += "    " + node.id + " [label=" + dot_text(node.label) +
              (node.topic ? ", shape=ellipse" : "") + "];\n";
    }
    text += "  }\n";
  }
  for (const Graph::Edge& edge : graph.edges) {
    text += "  " + edge.from + " -> " + edge.to +
            (edge.label.empty() ? "" : " [label=" + dot_text(edge.label) + "]") + ";\n";
  }
  return text + "}\n";
}

std::string to_mermaid(const Graph& graph) {
  std::string text = "flowchart LR\n";
  std::size_t number = 0;
  for (const std::string& system : systems_of(graph)) {
    text += "  subgraph s" + std::to_string(number++) + "[" + mermaid_text(system) + "]\n";
    for (const Graph::Node& node : graph.nodes) {
      if (node.system != system) continue;
      text += "    " + node.id + (node.topic ? "([" : "[") + mermaid_text(node.label) +
              (node.topic ? "])" : "]") + "\n";
    }
    text += "  end\n";
  }
  for (const Graph::Edge& edge : graph.edges) {
    text += "  " + edge.from + " -->" +
            (edge.label.empty() ? "" : "|" + mermaid_text(edge.label) + "|") + " " + edge.to + "\n";
  }
  return text;
}

nlohmann::ordered_json to_json(const Graph& graph) {
  auto nodes = nlohmann::ordered_json::array(), edges = nlohmann::ordered_json::array();
  for (const Graph::Node& node : graph.nodes) {
    nodes.push_back({{"id", node.id},
                     {"kind", node.topic ? "topic" : "peer"},
                     {"system", node.system},
                     {"label", node.label}});
  }
  for (const Graph::Edge& edge : graph.edges)
    edges.push_back({{"from", edge.from}, {"to", edge.to}, {"label", edge.label}});
  return {{"nodes", nodes}, {"edges", edges}};
}

int draw_graph(const GraphArguments& arguments) {
  const Interruption interruption;
  const std::string format = arguments.json ? "json" : arguments.format;
  Entity entity = join(arguments, "graph");
  const introspection::StatisticsReader statistics(EntityAccess::participant(entity));
  DomainLook look(entity, interruption.gives_up());
  if (arguments.seconds > 0) interruption.wait(arguments.seconds);
  Traffic traffic;
  traffic.before = look.take(true);
  const auto begin = std::chrono::steady_clock::now();
  interruption.wait(kBetweenLooks);
  DomainPicture picture = look.take(true);
  traffic.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  traffic.services = statistics.latest();
  if (!arguments.tools) std::erase_if(picture, is_tool);
  if (picture.empty()) tell_missions_elsewhere(arguments);
  const Graph graph = graph_of(picture, traffic);
  if (format == "json") {
    print_json(to_json(graph), true);
  } else {
    const std::string text = format == "mermaid" ? to_mermaid(graph)
                             : format == "dot"   ? to_dot(graph)
                                                 : picture_of(graph, format);
    std::fwrite(text.data(), 1, text.size(), stdout);
  }
  return 0;
}

}  // namespace skein::command
