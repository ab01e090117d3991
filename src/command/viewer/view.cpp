#include <cstdio>
#include <string>

#include "brokerless_discovery/broker.hpp"
#include "command/commands.hpp"
#include "command/print/interruption.hpp"
#include "entity/entity_access.hpp"
#include "service_feed.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "skein/inspector.hpp"
#include "skein/introspection.idl.hpp"
#include "topic_feed.hpp"
#include "view/server.hpp"

namespace skein::command {
namespace {

constexpr double kPeriodSeconds = 1;

view::Options server_options(const ViewArguments& arguments) {
  view::Options options;
  options.name = "skein, domain " + std::to_string(arguments.watched_domain());
  options.port = arguments.port;
  options.token = arguments.token.empty() ? view::random_token() : arguments.token;
  options.origins = arguments.origins;
  return options;
}

void add_services(view::Graph& graph, const brokerless_discovery::Broker& broker) {
  for (const auto& service : broker.all()) {
    graph.providers[service->service].insert(service->system + '/' + service->entity);
  }
}

}  // namespace

// Each second, while a client looks, shows the topics that entities have and the services that the
// broker knows.
int serve_view(const ViewArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "view");
  Inspector inspector(entity, interruption.gives_up());
  view::Server server(server_options(arguments));
  ServiceFeed services(server, entity, inspector);
  TopicFeed topics(server, EntityAccess::participant(entity), inspector);
  introspection::for_each_topic([&](const auto& topic) {
    if (topic.viewed) topics.show(topic);
  });
  std::printf(
      "Open this in Lichtblick or Foxglove, as a connection of the kind 'Foxglove WebSocket'. "
      "Whoever knows it may look.\n%s\n",
      server.url().c_str());
  std::fflush(stdout);
  do {
    if (server.clients() == 0) continue;  // nobody is asked while nobody looks
    const auto entities = topics.update();
    if (arguments.calls) services.update();
    view::Graph graph;
    add_topics(graph, entities);
    add_services(graph, entity.broker());
    server.set_graph(std::move(graph));
  } while (!interruption.wait(kPeriodSeconds));
  return 0;
}

}  // namespace skein::command
