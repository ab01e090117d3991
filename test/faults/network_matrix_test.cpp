// The cells of the fault matrix that strike the network. Each ends with FaultStage::check().
#include <catch2/catch.hpp>
#include <thread>

#include "../tools/seed.hpp"
#include "fault_stage.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

const std::set<std::string> kAnyEnd{"Ok", "Disconnected", "TimedOut", "Unavailable"};

struct Cell {
  const char* name;
  Disturbance disturbance;
};

}  // namespace

TEST_CASE("matrix: a network that loses, delays, repeats or reorders") {
  const Cell cell = GENERATE(Cell{"5 % loss", {.loss = 0.05}}, Cell{"20 % loss", {.loss = 0.20}},
                             Cell{"40 % loss", {.loss = 0.40}}, Cell{"50 ms jitter", {.jitter = 50ms}},
                             Cell{"30 % duplication", {.duplication = 0.3}},
                             Cell{"30 % reordering", {.reordering = 0.3}});
  CableStage hosts(seed_of_this_run(), 4);
  hosts.stage.start("timeout 2000 bytes 4000 pause 5");
  hosts.stage.run_for_calls(50);
  hosts.cable.disturb(cell.disturbance);
  hosts.stage.run_for_calls(100);
  hosts.stage.journal().mark();
  hosts.cable.heal();
  hosts.stage.stop();
  hosts.stage.check(cell.name, kAnyEnd);
  const auto counters = hosts.cable.counters();
  CHECK(counters.lost + counters.duplicated + counters.overtaken > 0);
}

TEST_CASE("matrix: a partition of 30 s") {
  CableStage hosts(seed_of_this_run(), 4);
  hosts.stage.start("timeout 1000 bytes 4000 pause 50");
  hosts.stage.run_for_calls(50);
  hosts.cable.disturb(Disturbance::cut());
  std::this_thread::sleep_for(30s);
  hosts.stage.journal().mark();
  hosts.cable.heal();
  hosts.stage.run_for_calls(50);
  hosts.stage.stop();
  hosts.stage.check("partition of 30 s", kAnyEnd);
}
