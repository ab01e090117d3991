#include "calls/configuration.hpp"

#include <algorithm>
#include <sstream>

#include "harness/placement.hpp"
#include "harness/skipped.hpp"
#include "rivals/main.hpp"

namespace skein::benchmarks {
namespace {

using Words = std::vector<std::string>;

std::optional<Child> ready_server(const Words& command, int network) {
  if (command.empty()) return std::nullopt;
  Child child(command, network);
  child.receive();
  return child;
}

void add_place(Words& command, const std::optional<Place>& place) {
  if (!place) return;
  for (const std::string& word :
       {std::string("--interface"), place->interface, std::string("--peer"), place->peer}) {
    command.push_back(word);
  }
}

}  // namespace

double cpu_us_of(Child& child) {
  child.send("cpu");
  return std::stod(child.receive().substr(4)) / 1000;
}

double between_us(Instant begin, const std::string& end_ns) {
  const auto begin_ns = std::chrono::nanoseconds(begin.time_since_epoch()).count();
  return static_cast<double>(std::stoll(end_ns) - begin_ns) / 1000;
}

Configuration Configurations::skein(const std::string& server, const std::string& client,
                                    std::size_t threads, const std::optional<Place>& server_place,
                                    const std::optional<Place>& client_place) {
  const std::string domain = next_domain();
  const auto command = [&](const char* role, const std::string& vendor) {
    return Words{
        folder_ + "/skein_bench", "peer", "--role", role, "--vendor", vendor, "--domain", domain};
  };
  Configuration made{"skein " + pair_name(server, client), command("server", server),
                     command("client", client)};
  made.server.insert(made.server.end(), {"--threads", std::to_string(threads)});
  add_place(made.server, server_place);
  add_place(made.client, client_place);
  return made;
}

Configuration Configurations::skein_same_host(SharedMemory how, std::size_t threads) {
  Configuration made = skein("fastdds", "fastdds", threads);
  made.name = "skein shared memory";
  for (Words* command : {&made.server, &made.client}) command->push_back("--shared-memory");
  if (how == SharedMemory::Sleeping) return made;
  made.name += ", spinning";
  made.needs_a_core_each = true;
  for (Words* command : {&made.server, &made.client}) {
    command->insert(command->end(), {"--spin-us", "100"});
  }
  return made;
}

Configuration Configurations::skein_lending() {
  Configuration made = skein_same_host(SharedMemory::Sleeping);
  *std::ranges::find(made.server, "server") = "viewer";
  *std::ranges::find(made.client, "client") = "lender";
  return made;
}

std::vector<std::string> Configurations::recorder_of(const Configuration& skein) {
  Words command = skein.client;
  *std::ranges::find(command, "client") = "recorder";
  return command;
}

Configuration Configurations::skein_topic(const std::string& vendor, const std::string& receiver) {
  const std::string domain = next_domain();
  const auto command = [&](const std::string& role) {
    return Words{
        folder_ + "/skein_bench", "peer", "--role", role, "--vendor", vendor, "--domain", domain};
  };
  return {receiver + " on " + vendor, command(receiver), command("publisher")};
}

Configuration Configurations::raw(const std::string& server, const std::string& client) {
  const std::string domain = next_domain();
  return {"raw " + pair_name(server, client),
          {folder_ + "/skein_bench_raw_" + server, "server", domain},
          {folder_ + "/skein_bench_raw_" + client, "client", domain}};
}

Configuration Configurations::raw_by(const std::string& vendor, const std::string& way) {
  const std::string domain = next_domain(), program = folder_ + "/skein_bench_raw_" + vendor;
  std::string words = way;
  std::ranges::replace(words, '_', ' ');
  return {vendor + " by " + words,
          {program, "server", domain, way},
          {program, "client", domain, way},
          way == "polling"};
}

Configuration Configurations::skein_alone(const std::string& name, const std::string& role,
                                          const std::string& vendor, std::size_t count) {
  return {name,
          {},
          {folder_ + "/skein_bench", "peer", "--role", role, "--vendor", vendor, "--domain",
           next_domain(), "--peers", std::to_string(count)}};
}

Configuration Configurations::skein_neighbour(const std::string& vendor, std::size_t count) {
  return skein_alone("skein " + vendor, "neighbour", vendor, count);
}

Configuration Configurations::raw_neighbour(const std::string& vendor, std::size_t count) {
  return {
      "raw " + vendor,
      {},
      {folder_ + "/skein_bench_raw_" + vendor, "neighbour", next_domain(), std::to_string(count)}};
}

Configuration Configurations::bystander(const std::string& vendor, std::size_t count) {
  return skein_alone("participants of " + vendor, "bystander", vendor, count);
}

Configuration Configurations::floor(const std::string& name, const std::string& program) {
  const std::string domain = next_domain();
  const std::string path = folder_ + "/skein_bench_raw_" + program;
  return {name, {path, "server", domain}, {path, "client", domain}, false};
}

Configuration Configurations::unix_socket(std::uint64_t resident) {
  Configuration made = floor("unix socket", "unix");
  if (resident > 0) made.server.push_back(std::to_string(resident));
  return made;
}

Configuration Configurations::shared_memory() {
  Configuration made = floor("spinning shared memory", "shared_memory");
  made.needs_a_core_each = true;
  return made;
}

Configuration Configurations::rival(const std::string& rival, const std::string& transport) {
  const std::string number = next_domain();
  const std::string program = folder_ + "/skein_bench_" + rival;
  return {rival + " " + transport,
          {program, "server", number, transport},
          {program, "client", number, transport}};
}

Configuration Configurations::skein_in_process() {
  return {"skein in one process", {}, {folder_ + "/skein_bench", "peer", "--role", "local"}};
}

Configuration Configurations::omniorb_in_process(const std::string& transport) {
  return {"omniorb " + transport,
          {},
          {folder_ + "/skein_bench_omniorb", "collocated", next_domain(), transport}};
}

Configuration Configurations::skein_head() {
  return {"skein", {}, {folder_ + "/skein_bench", "peer", "--role", "head"}};
}

Configuration Configurations::skein_finder() {
  return {"skein", {}, {folder_ + "/skein_bench", "peer", "--role", "finder"}};
}

Configuration Configurations::name_server(const std::string& log_folder) {
  const int number = std::stoi(next_domain());
  const std::string port = std::to_string(rivals::kFirstPort + number);
  return {"omniORB's name server",
          {"/usr/bin/omniNames", "-start", port, "-logdir", log_folder, "-ignoreport",
           "-ORBendPoint", "giop:tcp:127.0.0.1:" + port},
          {folder_ + "/skein_bench_omniorb", "names", std::to_string(number), "tcp"}};
}

Running::Running(const Configuration& configuration, int server_network, int client_network)
    : server(ready_server(configuration.server, server_network)),
      client(configuration.client, client_network) {
  const std::string line = client.receive();  // `ready TIME`
  first_reply_us = between_us(client.started(), line.substr(line.find(' ') + 1));
}

std::vector<double> Running::call(std::size_t size_bytes, std::size_t count) {
  return times("call " + std::to_string(size_bytes) + " " + std::to_string(count));
}

std::vector<double> Running::times(const std::string& command) {
  client.send(command);
  return times_us(client.receive());
}

void Running::place(Placement placement) {
  static const std::vector<int> cores = allowed_cores();
  if (placement == Placement::OneCoreEach && cores.size() < 2)
    throw Skipped("there is but one core here");
  const auto put = [](Child& child, int core) {
    child.send("place " + std::to_string(core));
    child.receive();
  };
  const int servers_core = placement == Placement::Anywhere ? -1 : cores[0];
  if (server) put(*server, servers_core);
  put(client, placement == Placement::OneCoreEach ? cores[1] : servers_core);
}

double Running::cpu_us() { return (server ? cpu_us_of(*server) : 0) + cpu_us_of(client); }

std::vector<double> times_us(const std::string& answer) {
  std::istringstream words(answer);
  std::string title;
  words >> title;
  std::vector<double> samples_us;
  for (double time_ns; words >> time_ns;) samples_us.push_back(time_ns / 1000);
  return samples_us;
}

std::string pair_name(const std::string& server, const std::string& client) {
  return server == client ? server : server + "-" + client;
}

std::vector<std::pair<std::string, std::string>> vendor_pairs() {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const char* server : kVendors) {
    for (const char* client : kVendors) pairs.emplace_back(server, client);
  }
  return pairs;
}

}  // namespace skein::benchmarks
