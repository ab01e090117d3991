#include <chrono>
#include <cstdio>
#include <map>
#include <optional>

#include "brokerless_discovery/broker.hpp"
#include "command/commands.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "core/printable.hpp"
#include "entity/entity_access.hpp"
#include "entity/statistics_topic.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"
#include "skein/inspector.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::command {
namespace {

// Of who is asked for its connections; who hangs is left out.
constexpr std::chrono::seconds kConnectionsWithin{1};

double microseconds(std::uint64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1000; }

void print_latency(const char* what, const introspection::Latency& latency) {
  if (latency.count == 0) return;
  std::printf("      %-7s mean %.1f  p50 %.1f  p90 %.1f  p99 %.1f  greatest %.1f us\n", what,
              microseconds(latency.mean), microseconds(latency.p50), microseconds(latency.p90),
              microseconds(latency.p99), microseconds(latency.greatest));
}

/// Who has connected to a service, and how.
struct Client {
  std::string name;  ///< `system/entity`.
  inspection::Connection connection;
};
using Clients = std::multimap<Guid, Client>;  // by provider

Clients clients_in(std::vector<Inspected>&& answers) {
  Clients clients;
  for (auto& [participant, answer] : answers) {
    for (auto& connection : answer.connections) {
      const Guid provider{connection.provider};
      clients.emplace(provider, Client{answer.entity, std::move(connection)});
    }
  }
  return clients;
}

void print_client(const Client& client) {
  const inspection::Connection& connection = client.connection;
  std::printf("    from %s: %s, %llu calls%s%s\n", printable(client.name).c_str(),
              printable(connection.transport).c_str(),
              static_cast<unsigned long long>(connection.calls),
              connection.not_faster.empty() ? "" : "; not faster: ",
              printable(connection.not_faster).c_str());
}

nlohmann::ordered_json json_of_client(const Client& client) {
  return {{"client", client.name},
          {"transport", client.connection.transport},
          {"not_faster", client.connection.not_faster},
          {"pending", client.connection.pending},
          {"calls", client.connection.calls}};
}

void print_service_statistics(const introspection::ServiceStatistics& service) {
  std::printf("%-40s %s/%s  waiting %u  running %u\n", printable(service.service).c_str(),
              printable(service.system).c_str(), printable(service.entity).c_str(), service.waiting,
              service.running);
  for (const auto& operation : service.operations) {
    std::printf(
        "    %s: received %llu, answered %llu, raised %llu, failed %llu, refused %llu, expired "
        "%llu\n",
        printable(operation.name).c_str(), static_cast<unsigned long long>(operation.received),
        static_cast<unsigned long long>(operation.answered),
        static_cast<unsigned long long>(operation.raised),
        static_cast<unsigned long long>(operation.failed),
        static_cast<unsigned long long>(operation.refused),
        static_cast<unsigned long long>(operation.expired));
    print_latency("waited", operation.waited);
    print_latency("ran", operation.ran);
  }
}

nlohmann::ordered_json json_of_service(const discovery::ServiceDescription& service) {
  auto attributes = nlohmann::ordered_json::object();
  for (const auto& attribute : service.attributes) attributes[attribute.name] = attribute.value;
  return {{"service", service.service}, {"system", service.system}, {"entity", service.entity},
          {"owner", service.owner},     {"host", service.host},     {"pid", service.pid},
          {"vendor", service.vendor},   {"attributes", attributes}};
}

void print_statistics(const std::vector<introspection::ServiceStatistics>& services,
                      const Clients& clients) {
  for (const auto& service : services) {
    print_service_statistics(service);
    const auto [first, last] = clients.equal_range(Guid{service.provider});
    for (auto client = first; client != last; ++client) print_client(client->second);
  }
}

void print_statistics_as_json(const std::vector<introspection::ServiceStatistics>& services,
                              const Clients& clients) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& service : services) {
    auto& json = list.emplace_back(json_of(service));
    json["connections"] = nlohmann::ordered_json::array();
    const auto [first, last] = clients.equal_range(Guid{service.provider});
    for (auto client = first; client != last; ++client) {
      json["connections"].push_back(json_of_client(client->second));
    }
  }
  print_json(list, true);
}

void print_service_list(const brokerless_discovery::Table::Found& services,
                        const std::string& place) {
  for (const auto& service : services) {
    std::printf("%-40s %s/%s  pid %u  %s\n", printable(service->service).c_str(),
                printable(service->system).c_str(), printable(service->entity).c_str(),
                service->pid, printable(service->vendor).c_str());
    for (const auto& attribute : service->attributes) {
      std::printf("    %s = %s\n", printable(attribute.name).c_str(),
                  printable(attribute.value).c_str());
    }
  }
  std::printf("%zu %s in %s\n", services.size(), services.size() == 1 ? "service" : "services",
              place.c_str());
}

void print_as_json(const brokerless_discovery::Table::Found& services) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& service : services) list.push_back(json_of_service(*service));
  print_json(list, true);
}

}  // namespace

int list_services(const ServicesArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "services");
  std::optional<introspection::StatisticsReader> statistics;
  std::optional<Inspector> inspector;
  if (arguments.statistics) {
    statistics.emplace(EntityAccess::participant(entity));
    inspector.emplace(entity, interruption.gives_up());
  }
  if (arguments.seconds > 0) interruption.wait(arguments.seconds);
  if (statistics) {
    const Clients clients =
        clients_in(inspector->ask_all(inspection::Subject::Connections, kConnectionsWithin));
    arguments.json ? print_statistics_as_json(statistics->latest(), clients)
                   : print_statistics(statistics->latest(), clients);
    return 0;
  }
  const auto services = entity.broker().all();
  arguments.json ? print_as_json(services)
                 : print_service_list(services, entity.broker().options().place);
  if (services.empty()) tell_missions_elsewhere(arguments);
  return 0;
}

}  // namespace skein::command
