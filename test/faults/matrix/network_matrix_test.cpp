// The cells of the fault matrix that strike the network. Each ends with FaultStage::check().
#include <catch2/catch.hpp>

#include "fault_stage.hpp"
#include "test/faults/processes.hpp"
#include "test/tools/seed.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

const std::set<std::string> kAnyEnd{"Ok", "Disconnected", "TimedOut", "Unavailable"};

void strike_with(const char* cell, const Disturbance& disturbance) {
  CableStage hosts(seed_of_this_run(), 8);
  hosts.stage.start("timeout 2000 bytes 4000 pause 5");
  hosts.stage.run_for_calls(50);
  hosts.cable.disturb(disturbance);
  hosts.stage.run_for_calls(100);
  hosts.stage.journal().mark();
  let_last(kNear);
  hosts.cable.heal();
  hosts.stage.stop();
  hosts.stage.check(cell, kAnyEnd);

  const auto counters = hosts.cable.counters();
  const bool delays = disturbance.jitter.count() > 0 || disturbance.reordering > 0;
  CHECK((counters.lost > 0) == (disturbance.loss > 0));
  CHECK((counters.duplicated > 0) == (disturbance.duplication > 0));
  CHECK((counters.overtaken > 0) == delays);
}

}  // namespace

TEST_CASE("matrix: a network loses 5 %") { strike_with("5 % loss", {.loss = 0.05}); }

TEST_CASE("matrix: a network loses 20 %") { strike_with("20 % loss", {.loss = 0.20}); }

TEST_CASE("matrix: a network loses 40 %", "[long]") { strike_with("40 % loss", {.loss = 0.40}); }

TEST_CASE("matrix: a network has a jitter of 50 ms") {
  strike_with("50 ms jitter", {.jitter = 50ms});
}

TEST_CASE("matrix: a network repeats 30 %") {
  strike_with("30 % duplication", {.duplication = 0.3});
}

TEST_CASE("matrix: a network reorders 30 %") {
  strike_with("30 % reordering", {.reordering = 0.3});
}

TEST_CASE("matrix: a partition of 30 s", "[long]") {
  CableStage hosts(seed_of_this_run(), 4);
  hosts.stage.start("timeout 1000 bytes 4000 pause 50");
  hosts.stage.run_for_calls(50);
  hosts.cable.disturb(Disturbance::cut());
  let_last(30s - kNear);
  hosts.stage.journal().mark();
  let_last(kNear);
  hosts.cable.heal();
  hosts.stage.run_for_calls(50);
  hosts.stage.stop();
  hosts.stage.check("partition of 30 s", kAnyEnd);
}
