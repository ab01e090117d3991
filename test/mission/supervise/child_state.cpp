#include "mission/supervise/child_state.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace skein::launch;
using namespace std::chrono_literals;
using skein::profile::ProcessRules;
using skein::profile::RestartPolicy;

namespace {

ProcessRules rules_with(RestartPolicy policy, int max_restarts = 2) {
  ProcessRules rules;
  rules.restart.policy = policy;
  rules.restart.delay = 100ms;
  rules.restart.max_delay = 1s;
  rules.restart.max_restarts = max_restarts;
  rules.restart.window = 10s;
  rules.ready_timeout = 5s;
  rules.progress_timeout = 1s;
  rules.stop_timeout = 3s;
  return rules;
}

enum class Event {
  Ready,
  Progress,
  ExitOk,
  ExitFailed,
  SpawnFailed,
  SpawnFailedForNow,
  Stop,
  Restart,
  Due,
  Early
};
constexpr Event kEvents[] = {Event::Ready,      Event::Progress,    Event::ExitOk,
                             Event::ExitFailed, Event::SpawnFailed, Event::SpawnFailedForNow,
                             Event::Stop,       Event::Restart,     Event::Due,
                             Event::Early};

/// The machine together with what an owner knows: whether a process runs, what was asked of it.
struct World {
  explicit World(const ProcessRules& rules) : machine(rules) {}

  ChildStateMachine machine;
  Time now{};
  bool alive = false;
  bool stopped = false;
  int interrupts = 0;
  int terminates = 0;
  int kills = 0;
  std::string broken;  ///< The first promise that did not hold.

  void expect(bool holds, const char* promise) {
    if (!holds && broken.empty()) broken = promise;
  }

  void obey(ChildAction action) {
    if (action == ChildAction::Spawn) {
      expect(!alive, "spawns only while no process runs");
      expect(!stopped, "spawns never after stop");
      alive = true;
      interrupts = terminates = kills = 0;
    } else if (action == ChildAction::Interrupt) {
      expect(alive && ++interrupts == 1, "interrupts a running process once");
    } else if (action == ChildAction::Terminate) {
      expect(alive && ++terminates == 1, "terminates a running process once");
      expect(interrupts == 1, "terminates what was interrupted before");
    } else if (action == ChildAction::Kill) {
      expect(alive && ++kills == 1, "kills a running process once");
    }
  }

  ChildAction give(Event event) {
    switch (event) {
      case Event::Ready:
        return machine.ready(now);
      case Event::Progress:
        return machine.progress(now);
      case Event::Restart:
        return machine.restart(now);
      case Event::ExitOk:
      case Event::ExitFailed:
        alive = false;
        return machine.exited(event == Event::ExitFailed, now);
      case Event::SpawnFailed:
      case Event::SpawnFailedForNow:
        alive = false;
        return machine.spawn_failed(event == Event::SpawnFailedForNow, now);
      case Event::Stop:
        stopped = true;
        return machine.stop(now);
      case Event::Due:
        now = machine.next_tick().value_or(now + 1s);
        return machine.tick(now);
      case Event::Early:
        return machine.tick(now);
    }
    return ChildAction::None;
  }

  void happen(Event event) {
    const bool was_final = machine.is_final() && (event != Event::Restart || stopped);
    const auto before = machine.state();
    obey(give(event));
    expect(machine.is_running() == alive, "knows whether a process runs");
    expect(!was_final || machine.state() == before, "ends once");
    expect(!machine.is_final() || !machine.next_tick(), "waits for nothing in the end");
    expect(machine.is_final() || machine.state() == ChildState::Killed || machine.next_tick(),
           "waits for ever only for a process that was killed");
    expect(!stopped || machine.state() != ChildState::Waiting, "waits for no restart after stop");
  }

  /// Whatever came before: a stop, what is due, and the end of a killed process end the child.
  void expect_stoppable() const {
    World world = *this;
    world.happen(Event::Stop);
    for (int i = 0; i < 2 && world.machine.next_tick(); ++i) world.happen(Event::Due);
    world.expect(!world.alive || world.kills == 1, "kills what does not end");
    if (world.alive) world.happen(Event::ExitFailed);
    world.expect(world.machine.is_final(), "can be stopped");
    if (!world.broken.empty()) FAIL(world.broken);
  }
};

/// Goes through every sequence of events up to a length; returns how many it saw.
std::size_t explore_child(const World& world, int length, std::vector<Event>& way) {
  if (!world.broken.empty()) {
    std::string text = world.broken + " after";
    for (const Event event : way) text += " " + std::to_string(static_cast<int>(event));
    FAIL(text);
  }
  world.expect_stoppable();
  if (length == 0) return 1;
  std::size_t count = 1;
  for (const Event event : kEvents) {
    World next = world;
    way.push_back(event);
    next.happen(event);
    count += explore_child(next, length - 1, way);
    way.pop_back();
  }
  return count;
}

/// The wait before each restart of a child that always fails, until it is given up.
std::vector<std::chrono::milliseconds> waits_of_a_failing_child(const ProcessRules& rules) {
  ChildStateMachine machine(rules);
  Time now{};
  machine.start(now);
  std::vector<std::chrono::milliseconds> waits;
  while (!machine.is_final() && waits.size() < 100) {
    machine.exited(true, now);
    if (machine.state() != ChildState::Waiting) continue;
    const Time due = machine.next_tick().value();
    waits.push_back(std::chrono::duration_cast<std::chrono::milliseconds>(due - now));
    now = due;
    machine.tick(now);
  }
  return waits;
}

}  // namespace

TEST_CASE("No order of deaths, hangs, stops and restarts breaks a promise of the child") {
  const auto policy =
      GENERATE(RestartPolicy::Never, RestartPolicy::OnFailure, RestartPolicy::Always);
  World world(rules_with(policy, 1));
  std::vector<Event> way;
  world.expect_stoppable();
  world.obey(world.machine.start(world.now));
  CHECK(explore_child(world, 6, way) > 500'000);
}

TEST_CASE("A child becomes ready once for each process") {
  ChildStateMachine machine(rules_with(RestartPolicy::Always));
  CHECK(machine.start(Time{}) == ChildAction::Spawn);
  CHECK(machine.start(Time{}) == ChildAction::None);
  machine.ready(Time{});
  CHECK(machine.state() == ChildState::Ready);
  machine.exited(false, Time{});
  CHECK(machine.state() == ChildState::Waiting);
  machine.ready(Time{});
  CHECK(machine.state() == ChildState::Waiting);
}

TEST_CASE("The policy decides which end is followed by a restart") {
  const auto [policy, failed, state] = GENERATE(table<RestartPolicy, bool, ChildState>({
      {RestartPolicy::Never, false, ChildState::Ended},
      {RestartPolicy::Never, true, ChildState::Lost},
      {RestartPolicy::OnFailure, false, ChildState::Ended},
      {RestartPolicy::OnFailure, true, ChildState::Waiting},
      {RestartPolicy::Always, false, ChildState::Waiting},
      {RestartPolicy::Always, true, ChildState::Waiting},
  }));
  ChildStateMachine machine(rules_with(policy));
  machine.start(Time{});
  machine.exited(failed, Time{});
  CHECK(machine.state() == state);
}

TEST_CASE("Restarts wait twice as long each time, up to a limit, until the child is given up") {
  CHECK(waits_of_a_failing_child(rules_with(RestartPolicy::OnFailure, 6)) ==
        std::vector<std::chrono::milliseconds>{100ms, 200ms, 400ms, 800ms, 1000ms, 1000ms});
}

TEST_CASE("A failure long ago counts no more") {
  ChildStateMachine machine(rules_with(RestartPolicy::OnFailure, 2));
  Time now{};
  machine.start(now);
  for (int i = 0; i < 20; ++i) {
    machine.ready(now);
    machine.exited(true, now);
    REQUIRE(machine.state() == ChildState::Waiting);
    CHECK(machine.next_tick().value() - now == 100ms);
    now = machine.next_tick().value();
    machine.tick(now);
    now += 10s - 100ms;  // The next failure comes exactly one window after this one.
  }
  CHECK(machine.restarts() == 20);
}

TEST_CASE("A process that does not become ready is killed, and that counts as a failure") {
  ChildStateMachine machine(rules_with(RestartPolicy::OnFailure));
  machine.start(Time{});
  CHECK(machine.tick(Time{} + 4999ms) == ChildAction::None);
  CHECK(machine.tick(Time{} + 5s) == ChildAction::Kill);
  machine.exited(false, Time{} + 5s);
  CHECK(machine.state() == ChildState::Waiting);
}

TEST_CASE("Starts that hang count however long they take, so that the child is given up") {
  auto rules = rules_with(RestartPolicy::OnFailure, 2);
  rules.ready_timeout = rules.restart.window;
  ChildStateMachine machine(rules);
  Time now{};
  machine.start(now);
  for (int i = 0; i < 10 && !machine.is_final(); ++i) {
    now = machine.next_tick().value();
    if (machine.tick(now) == ChildAction::Kill) machine.exited(true, now);
  }
  CHECK(machine.state() == ChildState::Lost);
  CHECK(machine.hang() == Hang::Start);
  CHECK(machine.restarts() == 2);
}

TEST_CASE("A ready process that makes no progress is killed, which counts as a failure") {
  ChildStateMachine machine(rules_with(RestartPolicy::OnFailure));
  machine.start(Time{});
  machine.ready(Time{});
  CHECK(machine.tick(Time{} + 900ms) == ChildAction::None);
  machine.progress(Time{} + 900ms);
  CHECK(machine.tick(Time{} + 1899ms) == ChildAction::None);
  CHECK(machine.tick(Time{} + 1900ms) == ChildAction::Kill);
  CHECK(machine.hang() == Hang::Progress);
  machine.exited(false, Time{} + 2s);
  CHECK(machine.state() == ChildState::Waiting);
}

TEST_CASE("Nobody asks for progress where the rules do not") {
  auto rules = rules_with(RestartPolicy::OnFailure);
  rules.progress_timeout = 0s;
  ChildStateMachine machine(rules);
  machine.start(Time{});
  machine.ready(Time{});
  machine.progress(Time{});
  CHECK_FALSE(machine.next_tick());
}

TEST_CASE("A child that was given up is started anew on request, with all of its restarts") {
  ChildStateMachine machine(rules_with(RestartPolicy::OnFailure, 1));
  machine.start(Time{});
  for (int round = 0; round < 3; ++round) {
    machine.exited(true, Time{});
    REQUIRE(machine.state() == ChildState::Waiting);
    machine.tick(machine.next_tick().value());
    machine.exited(true, Time{});
    REQUIRE(machine.state() == ChildState::Lost);
    CHECK(machine.restarts() == 1);
    CHECK(machine.restart(Time{}) == ChildAction::Spawn);
    CHECK(machine.restarts() == 0);
  }
}

TEST_CASE("A running child that is to be started anew is asked to end first") {
  ChildStateMachine machine(rules_with(RestartPolicy::Never));
  machine.start(Time{});
  machine.ready(Time{});
  CHECK(machine.restart(Time{}) == ChildAction::Interrupt);
  CHECK(machine.restart(Time{}) == ChildAction::None);
  CHECK(machine.exited(false, Time{}) == ChildAction::Spawn);
  CHECK(machine.state() == ChildState::Starting);
}

TEST_CASE("A ready process is given time to end, and a second request kills it at once") {
  ChildStateMachine machine(rules_with(RestartPolicy::Always));
  machine.start(Time{});
  machine.ready(Time{});
  CHECK(machine.stop(Time{}) == ChildAction::Interrupt);
  CHECK(machine.tick(Time{} + 1999ms) == ChildAction::None);
  SECTION("asked again") { CHECK(machine.stop(Time{} + 1s) == ChildAction::Kill); }
  SECTION("time passes") {
    CHECK(machine.tick(Time{} + 2s) == ChildAction::Terminate);
    CHECK(machine.tick(Time{} + 2999ms) == ChildAction::None);
    SECTION("asked again") { CHECK(machine.stop(Time{} + 2500ms) == ChildAction::Kill); }
    SECTION("more time passes") { CHECK(machine.tick(Time{} + 3s) == ChildAction::Kill); }
  }
  machine.exited(true, Time{} + 3s);
  CHECK(machine.state() == ChildState::Ended);
}

TEST_CASE("A program that cannot be started is not tried again") {
  ChildStateMachine machine(rules_with(RestartPolicy::Always));
  machine.start(Time{});
  machine.spawn_failed(false, Time{});
  CHECK(machine.state() == ChildState::Lost);
  CHECK_FALSE(machine.was_ready());
}

TEST_CASE("A start for which the machine lacks something for the moment counts as a failure") {
  ChildStateMachine machine(rules_with(RestartPolicy::OnFailure, 2));
  Time now{};
  machine.start(now);
  machine.ready(now);
  machine.exited(true, now);
  for (const auto wait : {100ms, 200ms}) {
    REQUIRE(machine.state() == ChildState::Waiting);
    CHECK(machine.next_tick().value() - now == wait);
    now = machine.next_tick().value();
    CHECK(machine.tick(now) == ChildAction::Spawn);
    machine.spawn_failed(true, now);
  }
  CHECK(machine.state() == ChildState::Lost);
  CHECK(machine.restarts() == 2);
}

TEST_CASE("A start that the machine lacks something for is not tried again without a policy") {
  ChildStateMachine machine(rules_with(RestartPolicy::Never));
  machine.start(Time{});
  machine.spawn_failed(true, Time{});
  CHECK(machine.state() == ChildState::Lost);
}

TEST_CASE("a wrong configuration is not mended by a restart, whatever the policy is") {
  const auto policy = GENERATE(RestartPolicy::OnFailure, RestartPolicy::Always);
  ProcessRules rules;
  rules.restart.policy = policy;
  ChildStateMachine machine(rules);
  const Time now{};
  machine.start(now);
  CHECK(machine.exited(true, now, true) == ChildAction::None);
  CHECK(machine.state() == ChildState::Lost);
  CHECK(machine.restart(now) == ChildAction::Spawn);  // somebody has mended it
}
