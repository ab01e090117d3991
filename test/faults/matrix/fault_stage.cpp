#include "fault_stage.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <sstream>

#include "check_calls.hpp"
#include "footprint.hpp"
#include "test/faults/processes.hpp"

namespace skein::test {
namespace {

using namespace std::chrono_literals;

/// More than any healing takes, on a loaded machine too.
constexpr auto kHealing = 60s;

}  // namespace

std::unique_ptr<ChildProcess> FaultStage::make_peer(const std::string& name,
                                                    const dds::Vendor& vendor, const Place& place,
                                                    std::chrono::milliseconds lease) {
  const std::string number = std::to_string(++last_number_);
  ChildProcess::Options options;
  options.arguments = {"vendor=" + vendor.name(), "name=" + name + number, "number=" + number,
                       "journal=" + journal_.place(), "lease=" + std::to_string(lease.count())};
  if (place.space != nullptr) {
    options.network = place.space->descriptor();
    options.arguments.push_back("interface=skein0");
    options.arguments.push_back("host=" + place.other_host);
  }
  return std::make_unique<ChildProcess>("tally_peer", options);
}

ChildProcess& FaultStage::add_server(const Place& place, std::size_t queue,
                                     std::chrono::milliseconds lease) {
  servers_.push_back(make_peer("server", *Pairing::get().server, place, lease));
  ChildProcess& server = *servers_.back();
  server.send("provide " + std::to_string(queue));
  server.expect("provided");
  return server;
}

ChildProcess& FaultStage::add_clients(int count, const Place& place,
                                      std::chrono::milliseconds lease) {
  auto process = make_peer("client", *Pairing::get().client, place, lease);
  process->send("connect " + std::to_string(count));
  clients_.push_back({std::move(process), last_number_, count});
  return *clients_.back().process;
}

std::vector<ChildProcess*> FaultStage::everybody() {
  std::vector<ChildProcess*> all;
  for (auto& server : servers_) all.push_back(server.get());
  for (auto& client : clients_) all.push_back(client.process.get());
  return all;
}

bool FaultStage::everybody_knows_all() {
  const auto count = "services " + std::to_string(servers_.size());
  return std::ranges::all_of(everybody(),
                             [&](ChildProcess* peer) { return peer->ask("services") == count; });
}

void FaultStage::connect() {
  for (auto& client : clients_) client.process->expect("connected", kHealing);
  REQUIRE(eventually([&] { return everybody_knows_all(); }, kHealing));
  for (ChildProcess* peer : everybody()) threads_.emplace_back(peer, footprint_of(*peer).threads);
}

void FaultStage::start(const std::string& shape) {
  for (auto& client : clients_) client.process->send("start " + shape);
  for (auto& client : clients_) client.process->expect("started");
}

void FaultStage::run_for_calls(int calls) {
  const auto executed = [&] { return journal_.executions(); };
  const auto before = executed();
  REQUIRE(
      eventually([&] { return executed() >= before + static_cast<std::size_t>(calls); }, kHealing));
}

void FaultStage::stop() {
  for (auto& client : clients_) client.process->send("stop");
  for (auto& client : clients_) client.process->expect("stopped", kHealing);
}

void FaultStage::bury(ChildProcess& server) {
  std::erase_if(threads_, [&](const auto& entry) { return entry.first == &server; });
  std::erase_if(servers_, [&](const auto& owned) { return owned.get() == &server; });
}

void FaultStage::bury_clients(ChildProcess& clients, bool killed) {
  const auto found =
      std::ranges::find(clients_, &clients, [](const Clients& all) { return all.process.get(); });
  if (killed) journal_.bury(found->number);
  std::erase_if(threads_, [&](const auto& entry) { return entry.first == &clients; });
  clients_.erase(found);
}

bool FaultStage::nothing_left() {
  std::size_t expected = 0, active = 0, clients = 0, sessions = 0;
  for (const auto& client : clients_) expected += static_cast<std::size_t>(client.count);
  for (auto& server : servers_) {
    server->send("server");
    std::istringstream counts(server->expect("server"));
    std::size_t one[3]{};
    counts >> one[0] >> one[1] >> one[2];
    active += one[0], clients += one[1], sessions += one[2];
  }
  UNSCOPED_INFO(active << " active, " << clients << " clients, " << sessions << " sessions");
  return active == 0 && clients == expected && sessions == expected;
}

void FaultStage::check_healed() {
  CHECK(eventually([&] { return everybody_knows_all(); }, kHealing));
  for (auto& client : clients_) client.process->send("call timeout 20000");
  for (auto& client : clients_) CHECK(client.process->read(2 * kHealing) == "called Ok");
  for (auto& client : clients_) CHECK(client.process->ask("pending") == "pending 0");
  CHECK(eventually([&] { return nothing_left(); }));
}

void FaultStage::check(const std::string& cell, const std::set<std::string>& outcomes,
                       int max_late) {
  INFO(cell);
  check_healed();
  for (const auto& [peer, before] : threads_) {
    CHECK(eventually(
        [&, peer = peer, before = before] { return footprint_of(*peer).threads <= before; }));
  }
  check_calls(journal_, cell, outcomes, max_late);
}

CableStage::CableStage(std::uint64_t seed, int clients)
    : cable(here, there, seed), server(stage.add_server({&here, "10.77.0.2"})) {
  stage.add_clients(clients, {&there, "10.77.0.1"});
  stage.connect();
}

}  // namespace skein::test
