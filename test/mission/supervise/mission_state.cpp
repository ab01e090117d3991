#include "mission/supervise/mission_state.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace skein::launch;
using namespace std::chrono_literals;
using skein::profile::LossPolicy;
using skein::profile::RestartPolicy;

namespace {

ChildPlan child(const std::string& name, std::size_t layer = 0,
                const std::vector<std::vector<std::string>>& after = {}) {
  ChildPlan plan;
  plan.name = name;
  plan.layer = layer;
  for (const auto& providers : after) plan.after.push_back({"I", providers});
  plan.rules.on_loss = LossPolicy::Continue;
  plan.rules.restart.policy = RestartPolicy::OnFailure;
  plan.rules.restart.max_restarts = 1;
  plan.rules.progress_timeout = 1s;
  return plan;
}

LaunchPlan plan_of(std::vector<ChildPlan> children) { return {"m", std::move(children), {}}; }

/// `b` needs `a`, and `c` needs `b` or `a2`; `a` has a CSP with a process of its own.
LaunchPlan small_mission() {
  auto c = child("c", 2, {{"b", "a2"}});
  c.runs_mission = true;
  c.rules.restart.policy = RestartPolicy::Never;
  auto a2 = child("a2");
  a2.rules.on_loss = LossPolicy::Degrade;
  return plan_of({child("a"), child("a/csp"), a2, child("b", 1, {{"a"}}), c});
}

std::vector<std::size_t> spawned(const MissionState::Steps& steps) {
  std::vector<std::size_t> children;
  for (const auto& step : steps) {
    if (step.action == ChildAction::Spawn) children.push_back(step.child);
  }
  return children;
}

using Children = std::vector<std::size_t>;

/// A mission together with what its owner knows: which processes run.
struct MissionWorld {
  explicit MissionWorld(const LaunchPlan& its_plan)
      : plan(&its_plan), mission(its_plan), alive(its_plan.children.size()) {
    obey(mission.start(now));
  }

  const LaunchPlan* plan;
  MissionState mission;
  Time now{};
  std::vector<bool> alive;
  bool stopped = false;
  std::string broken;  ///< The first promise that did not hold.

  enum class Kind {
    Ready,
    Progress,
    ExitOk,
    ExitFailed,
    SpawnFailed,
    SpawnFailedForNow,
    Restart,
    Stop,
    Due
  };
  struct Event {
    Kind kind;
    std::size_t child;
  };

  void expect(bool holds, const char* promise) {
    if (!holds && broken.empty()) broken = promise;
  }

  void obey(const MissionState::Steps& steps) {
    for (const auto& [i, action] : steps) {
      if (action == ChildAction::Spawn) {
        expect(!alive[i], "starts only what does not run");
        expect(!stopped && !mission.verdict(), "starts nothing once the mission ends");
        alive[i] = true;
      } else {
        expect(alive[i], "signals only what runs");
      }
    }
    for (std::size_t i = 0; i < alive.size(); ++i) {
      const auto& machine = mission.child(i);
      expect(machine.is_running() == alive[i], "knows what runs");
      expect(machine.state() != ChildState::Idle || mission.verdict() || waits(i),
             "starts what waits for nothing that may still come");
    }
    expect(!mission.all_final() || mission.verdict().has_value(), "ends with its last child");
  }

  /// Whether a child's prerequisites justify that it was not started.
  bool waits(std::size_t i) const {
    const auto& after = plan->children[i].after;
    return std::any_of(after.begin(), after.end(), [&](const Prerequisite& prerequisite) {
      bool may_come = false;
      for (const std::string& provider : prerequisite.providers) {
        const std::size_t peer = number_of(provider);
        if (is_there(provider)) return false;
        may_come = may_come || !mission.child(peer).is_final();
      }
      return may_come;
    });
  }

  std::size_t number_of(const std::string& name) const {
    for (std::size_t i = 0; i < plan->children.size(); ++i) {
      if (plan->children[i].name == name) return i;
    }
    throw std::logic_error(name);
  }

  bool is_there(const std::string& peer) const {
    for (std::size_t i = 0; i < plan->children.size(); ++i) {
      const std::string& name = plan->children[i].name;
      const auto& machine = mission.child(i);
      const bool there = machine.state() == ChildState::Ready;
      if (name == peer && !there) return false;
      if (name.starts_with(peer + "/") && !there && !machine.is_final()) return false;
    }
    return true;
  }

  void happen(const Event& event) {
    const std::size_t i = event.child;
    switch (event.kind) {
      case Kind::Ready:
        return obey(mission.ready(i, now));
      case Kind::Progress:
        return obey(mission.progress(i, now));
      case Kind::ExitOk:
      case Kind::ExitFailed:
        alive[i] = false;
        return obey(mission.exited(i, event.kind == Kind::ExitFailed, now));
      case Kind::SpawnFailed:
      case Kind::SpawnFailedForNow:
        alive[i] = false;
        return obey(mission.spawn_failed(i, event.kind == Kind::SpawnFailedForNow, now));
      case Kind::Restart:
        return obey(mission.restart(i, now));
      case Kind::Stop:
        stopped = true;
        return obey(mission.stop(now));
      case Kind::Due:
        now = mission.next_tick().value();
        return obey(mission.tick(now));
    }
  }

  /// What can happen now.
  std::vector<Event> events() const {
    std::vector<Event> all;
    for (std::size_t i = 0; i < alive.size(); ++i) {
      const ChildState state = mission.child(i).state();
      if (state == ChildState::Starting) all.push_back({Kind::Ready, i});
      if (state == ChildState::Starting) all.push_back({Kind::SpawnFailed, i});
      if (state == ChildState::Starting) all.push_back({Kind::SpawnFailedForNow, i});
      if (alive[i]) all.push_back({Kind::ExitOk, i});
      if (alive[i]) all.push_back({Kind::ExitFailed, i});
      if (mission.child(i).is_final() || state == ChildState::Ready)
        all.push_back({Kind::Restart, i});
    }
    all.push_back({Kind::Stop, 0});
    if (mission.next_tick()) all.push_back({Kind::Due, 0});
    return all;
  }

  /// Whatever came before: once it is told to stop, and nobody ends before he is killed.
  void expect_stoppable() const {
    MissionWorld world = *this;
    world.happen({Kind::Stop, 0});
    int ticks = 0;
    for (; !world.mission.all_final() && ticks < 20; ++ticks) {
      if (world.mission.next_tick()) world.happen({Kind::Due, 0});
      for (std::size_t i = 0; i < world.alive.size(); ++i) {
        if (world.mission.child(i).state() == ChildState::Killed)
          world.happen({Kind::ExitFailed, i});
      }
    }
    world.expect(world.mission.all_final(), "ends within bounded time when it is stopped");
    if (!world.broken.empty()) FAIL(world.broken);
  }

  /// Whatever came before: if from now on everything goes well, all that can be ready is.
  void expect_no_deadlock() const {
    MissionWorld world = *this;
    for (int i = 0; i < 40 && !world.is_at_rest(); ++i) {
      for (std::size_t child = 0; child < world.alive.size(); ++child) {
        const ChildState state = world.mission.child(child).state();
        if (state == ChildState::Starting) world.happen({Kind::Ready, child});
        if (state == ChildState::Ready) world.happen({Kind::Progress, child});
        if (state == ChildState::Interrupted || state == ChildState::Killed)
          world.happen({Kind::ExitFailed, child});
      }
      if (!world.is_at_rest() && world.mission.next_tick()) world.happen({Kind::Due, 0});
    }
    world.expect(world.is_at_rest(), "comes to rest when all goes well");
    if (!world.broken.empty()) FAIL(world.broken);
  }

  bool is_at_rest() const {
    for (std::size_t i = 0; i < alive.size(); ++i) {
      const auto& machine = mission.child(i);
      if (machine.state() != ChildState::Ready && !machine.is_final()) return false;
    }
    return true;
  }
};

/// Goes through every sequence of events up to a length; returns how many it saw.
std::size_t explore(const MissionWorld& world, int length, std::vector<MissionWorld::Event>& way) {
  if (!world.broken.empty()) {
    std::string text = world.broken + " after";
    for (const auto& event : way)
      text +=
          " " + std::to_string(static_cast<int>(event.kind)) + ":" + std::to_string(event.child);
    FAIL(text);
  }
  world.expect_stoppable();
  world.expect_no_deadlock();
  if (length == 0) return 1;
  std::size_t count = 1;
  for (const auto& event : world.events()) {
    MissionWorld next = world;
    way.push_back(event);
    next.happen(event);
    count += explore(next, length - 1, way);
    way.pop_back();
  }
  return count;
}

}  // namespace

TEST_CASE("No order of deaths, restarts, hangs and stops wedges a mission or breaks its promises") {
  const LaunchPlan plan = small_mission();
  std::vector<MissionWorld::Event> way;
  CHECK(explore(MissionWorld(plan), 5, way) > 100'000);
}

TEST_CASE("A child starts with the very event that makes ready the last it waits for") {
  const LaunchPlan plan = plan_of({child("a"), child("b"), child("c", 1, {{"a"}, {"b"}})});
  MissionState mission(plan);
  CHECK(spawned(mission.start(Time{})) == Children{0, 1});
  CHECK(spawned(mission.ready(1, Time{})).empty());
  CHECK(spawned(mission.ready(0, Time{})) == Children{2});
}

TEST_CASE("Of several providers the first that is ready is enough") {
  const LaunchPlan plan = plan_of({child("a"), child("b"), child("c", 1, {{"a", "b"}})});
  MissionState mission(plan);
  mission.start(Time{});
  CHECK(spawned(mission.ready(1, Time{})) == Children{2});
}

TEST_CASE("A peer counts as ready when its CSPs' processes are, too, or are given up") {
  const LaunchPlan plan =
      plan_of({child("a"), child("a/csp"), child("ab"), child("c", 1, {{"a"}})});
  MissionState mission(plan);
  CHECK(spawned(mission.start(Time{})) == Children{0, 1, 2});
  CHECK(spawned(mission.ready(0, Time{})).empty());
  SECTION("ready") { CHECK(spawned(mission.ready(1, Time{})) == Children{3}); }
  SECTION("given up") { CHECK(spawned(mission.spawn_failed(1, false, Time{})) == Children{3}); }
}

TEST_CASE("The death of the last provider does not hold up who waits for it") {
  auto never = child("a");
  never.rules.restart.policy = RestartPolicy::Never;
  const LaunchPlan plan = plan_of({never, child("b", 1, {{"a"}})});
  MissionState mission(plan);
  mission.start(Time{});
  CHECK(spawned(mission.exited(0, true, Time{})) == Children{1});
}

TEST_CASE("A provider that is restarted is waited for, until it is ready or given up") {
  const LaunchPlan plan = plan_of({child("a"), child("b", 1, {{"a"}})});
  MissionState mission(plan);
  mission.start(Time{});
  CHECK(spawned(mission.exited(0, true, Time{})).empty());
  const Time again = mission.next_tick().value();
  CHECK(spawned(mission.tick(again)) == Children{0});
  SECTION("ready") { CHECK(spawned(mission.ready(0, again)) == Children{1}); }
  SECTION("given up") { CHECK(spawned(mission.exited(0, true, again)) == Children{1}); }
}

TEST_CASE("A restart that was announced is made, or the mission's end takes its place") {
  const LaunchPlan plan = plan_of({child("a"), child("b")});
  MissionState mission(plan);
  mission.start(Time{});
  mission.exited(0, true, Time{});
  REQUIRE(mission.child(0).state() == ChildState::Waiting);
  SECTION("made") { CHECK(spawned(mission.tick(mission.next_tick().value())) == Children{0}); }
  SECTION("the mission ends") {
    mission.stop(Time{});
    CHECK(mission.child(0).state() == ChildState::Ended);
  }
}

TEST_CASE("Who waits for each other, or for who comes later, is started all the same") {
  const LaunchPlan plan = plan_of(
      {child("a", 0, {{"b"}}), child("b", 0, {{"a"}}), child("c", 1, {{"d"}}), child("d", 2)});
  MissionState mission(plan);
  CHECK(spawned(mission.start(Time{})) == Children{0, 1, 2, 3});
}

TEST_CASE("What the loss of a child means is its policy's to say") {
  const auto policy = GENERATE(LossPolicy::Abort, LossPolicy::Degrade, LossPolicy::Continue);
  auto a = child("a");
  a.rules.on_loss = policy;
  const LaunchPlan plan = plan_of({a, child("b")});
  MissionState mission(plan);
  mission.start(Time{});
  const auto steps = mission.spawn_failed(0, false, Time{});
  CHECK(mission.is_degraded() == (policy == LossPolicy::Degrade));
  if (policy == LossPolicy::Abort) {
    REQUIRE(mission.verdict());
    CHECK(mission.verdict()->end == MissionState::End::Lost);
    CHECK(mission.verdict()->child == 0);
    REQUIRE(steps.size() == 1);
    CHECK(steps[0].child == 1);
    CHECK(steps[0].action == ChildAction::Interrupt);
  } else {
    CHECK_FALSE(mission.verdict());
    CHECK(spawned(mission.restart(0, Time{})) == Children{0});
  }
}

TEST_CASE("A wrong configuration ends the mission, unless it goes on without that child anyway") {
  const auto policy = GENERATE(LossPolicy::Abort, LossPolicy::Degrade, LossPolicy::Continue);
  const bool was_ready = GENERATE(false, true);
  CAPTURE(policy, was_ready);
  auto a = child("a");
  a.rules.on_loss = policy;
  const LaunchPlan plan = plan_of({a, child("b")});
  MissionState mission(plan);
  mission.start(Time{});
  if (was_ready) mission.ready(0, Time{});
  mission.exited(0, true, Time{}, true);
  const bool ends = policy == LossPolicy::Abort || (policy == LossPolicy::Degrade && !was_ready);
  REQUIRE(mission.verdict().has_value() == ends);
  if (ends) CHECK(mission.verdict()->end == MissionState::End::Lost);
}

TEST_CASE("The first cause is the verdict, whatever follows from it") {
  auto a = child("a");
  a.rules.on_loss = LossPolicy::Abort;
  auto b = child("b");
  b.runs_mission = true;
  const LaunchPlan plan = plan_of({a, b});
  MissionState mission(plan);
  mission.start(Time{});
  mission.exited(1, false, Time{});
  mission.exited(0, true, Time{});
  mission.stop(Time{});
  CHECK(mission.all_final());
  CHECK(mission.verdict()->end == MissionState::End::MissionEnded);
}
