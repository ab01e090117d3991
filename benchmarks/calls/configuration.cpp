#include "calls/configuration.hpp"

#include <sstream>

namespace skein::benchmarks {
namespace {

using Words = std::vector<std::string>;

std::string pair_name(const std::string& server, const std::string& client) {
  return server == client ? server : server + "-" + client;
}

Child ready(Child child) {
  child.receive();
  return child;
}

void add_place(Words& command, const std::optional<Place>& place) {
  if (!place) return;
  for (const std::string& word : {std::string("--interface"), place->interface, std::string("--peer"),
                                  place->peer}) {
    command.push_back(word);
  }
}

double between_us(Instant begin, const std::string& end_ns) {
  const auto begin_ns = std::chrono::nanoseconds(begin.time_since_epoch()).count();
  return static_cast<double>(std::stoll(end_ns) - begin_ns) / 1000;
}

}  // namespace

Configuration Configurations::skein(const std::string& server, const std::string& client,
                                    std::size_t threads, const std::optional<Place>& server_place,
                                    const std::optional<Place>& client_place) {
  const std::string domain = next_domain();
  const auto command = [&](const char* role, const std::string& vendor) {
    return Words{folder_ + "/skein_bench", "peer", "--role", role, "--vendor", vendor, "--domain", domain};
  };
  Configuration made{"skein " + pair_name(server, client), command("server", server),
                     command("client", client)};
  made.server.insert(made.server.end(), {"--threads", std::to_string(threads)});
  add_place(made.server, server_place);
  add_place(made.client, client_place);
  return made;
}

Configuration Configurations::raw(const std::string& server, const std::string& client) {
  const std::string domain = next_domain();
  return {"raw " + pair_name(server, client),
          {folder_ + "/skein_bench_raw_" + server, "server", domain},
          {folder_ + "/skein_bench_raw_" + client, "client", domain}};
}

Configuration Configurations::unix_socket() {
  const std::string domain = next_domain();
  const std::string program = folder_ + "/skein_bench_raw_unix";
  return {"unix socket", {program, "server", domain}, {program, "client", domain}};
}

Running::Running(const Configuration& configuration, int server_network, int client_network)
    : server(ready(Child(configuration.server, server_network))),
      client(configuration.client, client_network) {
  const std::string line = client.receive();  // `ready TIME`
  first_reply_us = between_us(client.started(), line.substr(line.find(' ') + 1));
}

std::vector<double> Running::call(std::size_t size_bytes, std::size_t count) {
  client.send("call " + std::to_string(size_bytes) + " " + std::to_string(count));
  std::istringstream words(client.receive());
  std::string title;
  words >> title;
  std::vector<double> samples_us;
  for (double time_ns; words >> time_ns;) samples_us.push_back(time_ns / 1000);
  return samples_us;
}

std::vector<std::pair<std::string, std::string>> vendor_pairs() {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const char* server : kVendors) {
    for (const char* client : kVendors) pairs.emplace_back(server, client);
  }
  return pairs;
}

}  // namespace skein::benchmarks
