#include "fault_stage.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "check_calls.hpp"
#include "processes.hpp"

namespace skein::test {
namespace {

using namespace std::chrono_literals;

/// More than any healing takes, on a loaded machine too.
constexpr auto kHealing = 60s;

std::size_t threads_of(const ChildProcess& peer) {
  const std::filesystem::directory_iterator tasks("/proc/" + std::to_string(peer.pid()) + "/task");
  return static_cast<std::size_t>(std::distance(begin(tasks), end(tasks)));
}

}  // namespace

ChildProcess& FaultStage::add(std::vector<std::unique_ptr<ChildProcess>>& to,
                              const std::string& name, const dds::Vendor& vendor,
                              const Place& place, std::chrono::milliseconds lease) {
  const std::string number = std::to_string(++last_number_);
  ChildProcess::Options options;
  options.arguments = {"vendor=" + vendor.name(), "name=" + name + number, "number=" + number,
                       "journal=" + journal_.place(), "lease=" + std::to_string(lease.count())};
  if (place.space != nullptr) {
    options.network = place.space->descriptor();
    options.arguments.push_back("interface=skein0");
    options.arguments.push_back("host=" + place.other_host);
  }
  to.push_back(std::make_unique<ChildProcess>("tally_peer", options));
  return *to.back();
}

ChildProcess& FaultStage::add_server(const Place& place, std::size_t queue,
                                     std::chrono::milliseconds lease) {
  ChildProcess& server = add(servers_, "server", *Pairing::get().server, place, lease);
  server.send("provide " + std::to_string(queue));
  server.expect("provided");
  return server;
}

ChildProcess& FaultStage::add_clients(int count, const Place& place,
                                      std::chrono::milliseconds lease) {
  ChildProcess& client = add(clients_, "client", *Pairing::get().client, place, lease);
  client.send("connect " + std::to_string(count));
  client_count_ += count;
  return client;
}

std::vector<ChildProcess*> FaultStage::everybody() {
  std::vector<ChildProcess*> all;
  for (auto* group : {&servers_, &clients_}) {
    for (auto& peer : *group) all.push_back(peer.get());
  }
  return all;
}

bool FaultStage::everybody_knows_all() {
  const auto count = "services " + std::to_string(servers_.size());
  return std::ranges::all_of(everybody(),
                             [&](ChildProcess* peer) { return peer->ask("services") == count; });
}

void FaultStage::connect() {
  for (auto& client : clients_) client->expect("connected", kHealing);
  REQUIRE(eventually([&] { return everybody_knows_all(); }, kHealing));
  for (ChildProcess* peer : everybody()) threads_.emplace_back(peer, threads_of(*peer));
}

void FaultStage::start(const std::string& shape) {
  for (auto& client : clients_) client->send("start " + shape);
  for (auto& client : clients_) client->expect("started");
}

void FaultStage::run_for_calls(int calls) {
  const auto executed = [&] { return journal_.executions(); };
  const auto before = executed();
  REQUIRE(
      eventually([&] { return executed() >= before + static_cast<std::size_t>(calls); }, kHealing));
}

void FaultStage::stop() {
  for (auto& client : clients_) client->send("stop");
  for (auto& client : clients_) client->expect("stopped", kHealing);
}

void FaultStage::bury(ChildProcess& server) {
  std::erase_if(threads_, [&](const auto& entry) { return entry.first == &server; });
  std::erase_if(servers_, [&](const auto& owned) { return owned.get() == &server; });
}

void FaultStage::check(const std::string& cell, const std::set<std::string>& outcomes) {
  INFO(cell);
  const auto healing_since = std::chrono::steady_clock::now();
  CHECK(eventually([&] { return everybody_knows_all(); }, kHealing));
  for (auto& client : clients_) client->send("call timeout 20000");
  for (auto& client : clients_) CHECK(client->read(2 * kHealing) == "called Ok");
  const auto healed_in = std::chrono::steady_clock::now() - healing_since;

  for (auto& client : clients_) CHECK(client->ask("pending") == "pending 0");
  const auto count_all = [&] {
    std::size_t active = 0, clients = 0, sessions = 0;
    for (auto& server : servers_) {
      server->send("server");
      std::istringstream counts(server->expect("server"));
      std::size_t one[3]{};
      counts >> one[0] >> one[1] >> one[2];
      active += one[0], clients += one[1], sessions += one[2];
    }
    UNSCOPED_INFO(active << " active, " << clients << " clients, " << sessions << " sessions");
    return active == 0 && clients == static_cast<std::size_t>(client_count_) && sessions == clients;
  };
  CHECK(eventually(count_all));
  for (const auto& [peer, before] : threads_) {
    CHECK(eventually([&, peer = peer, before = before] { return threads_of(*peer) <= before; }));
  }
  check_calls(journal_, cell, outcomes);
  std::printf("%s: all tables complete and all clients served %.0f ms after\n", cell.c_str(),
              std::chrono::duration<double, std::milli>(healed_in).count());
}

CableStage::CableStage(std::uint64_t seed, int clients)
    : cable(here, there, seed), server(stage.add_server({&here, "10.77.0.2"})) {
  stage.add_clients(clients, {&there, "10.77.0.1"});
  stage.connect();
}

}  // namespace skein::test
