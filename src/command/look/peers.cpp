#include <cstdio>

#include "command/commands.hpp"
#include "command/print/figures.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "core/printable.hpp"
#include "domain_picture.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"

namespace skein::command {
namespace {

/// By its own answer; without one, by what the Broker knows of its services.
struct Row {
  std::string host = "?";
  std::uint32_t pid = 0;
  std::string vendor = "?";
};

Row row_of(const PeerPicture& peer) {
  if (peer.process) return {peer.process->host, peer.process->pid, peer.process->vendor};
  if (peer.services.empty()) return {};
  const auto& service = *peer.services.front();
  return {service.host, service.pid, service.vendor};
}

void print_services(const PeerPicture& peer) {
  for (const auto& service : peer.services) {
    std::printf("    %s %s", service->owner.empty() ? "provides" : "is a CSP,",
                printable(service->service).c_str());
    if (!service->owner.empty()) {
      std::printf(": %s of %s", printable(service->entity).c_str(),
                  printable(service->owner).c_str());
    }
    std::printf("\n");
  }
}

void print_peer(const PeerPicture& peer) {
  const Row row = row_of(peer);
  std::printf("%-28s %s, pid %u, on %s", printable(peer.name).c_str(), printable(row.host).c_str(),
              row.pid, printable(row.vendor).c_str());
  if (const auto& process = peer.process) {
    std::printf(
        ", Skein %s, up %s, %s, %u threads, %s of CPU time%s\n",
        printable(process->version).c_str(), short_time(process->time - process->started).c_str(),
        short_size(process->memory).c_str(), process->threads, short_time(process->cpu).c_str(),
        process->degraded ? ", degraded: CSPs do not return" : "");
  } else {
    std::printf(", does not answer\n");
  }
  print_services(peer);
}

nlohmann::ordered_json json_of_peer(const PeerPicture& peer) {
  const Row row = row_of(peer);
  auto services = nlohmann::ordered_json::array();
  for (const auto& service : peer.services) {
    services.push_back(
        {{"service", service->service}, {"entity", service->entity}, {"owner", service->owner}});
  }
  nlohmann::ordered_json json{{"name", peer.name},    {"participant", peer.participant.hex()},
                              {"host", row.host},     {"pid", row.pid},
                              {"vendor", row.vendor}, {"answers", peer.process.has_value()}};
  if (peer.process) json["process"] = json_of(*peer.process);
  json["services"] = services;
  return json;
}

}  // namespace

int list_peers(const PeersArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "peers");
  DomainLook look(entity, interruption.gives_up());
  if (arguments.seconds > 0) interruption.wait(arguments.seconds);
  const DomainPicture picture = look.take(false);
  if (arguments.json) {
    auto list = nlohmann::ordered_json::array();
    for (const PeerPicture& peer : picture) list.push_back(json_of_peer(peer));
    print_json(list, true);
    return 0;
  }
  for (const PeerPicture& peer : picture) print_peer(peer);
  std::printf("%zu %s in %s\n", picture.size(), picture.size() == 1 ? "peer" : "peers",
              entity.broker().options().place.c_str());
  if (picture.empty()) tell_missions_elsewhere(arguments);
  return 0;
}

}  // namespace skein::command
