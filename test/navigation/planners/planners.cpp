#include "navigation/planners/planners.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <thread>

#include "skein/call_context.hpp"
#include "skein/error.hpp"
#include "test/navigation/demo.hpp"
#include "test/navigation/flat_crossing.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::NoRoute;
using AE_navigator::Problem;
using AE_navigator::Route;

namespace {

/// What this thread has computed: a busy machine does not count.
std::chrono::nanoseconds thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

void check_every_planner(std::initializer_list<std::uint32_t> seeds) {
  for (const std::uint32_t seed : seeds) {
    Demo demo(seed);
    demo.problem.time_limit_ms = 20000;
    for (const std::string name : {"AStar", "RRTConnect"}) {
      INFO(name << " on " << demo.problem.terrain);
      const Route route = demo.plan(name);
      CHECK(demo.violations(route) == "");
      CHECK(route.planner == name);
    }
    demo.problem.time_limit_ms = 0;
    INFO("RRTstar on " << demo.problem.terrain);
    CHECK(demo.violations(demo.plan("RRTstar")) == "");
  }
}

void check_turns(std::initializer_list<std::uint32_t> seeds) {
  for (const std::uint32_t seed : seeds) {
    for (const double speed : {40.0, 60.0, 100.0}) {
      for (const double height : {60.0, 150.0}) {
        Demo demo(seed);
        demo.problem.limits.speed_m_s = speed;
        demo.problem.minimum_height_above_ground_m = height;
        INFO("seed " << seed << ", " << speed << " m/s, " << height << " m above the ground");
        const Route route = demo.plan("AStar");
        CHECK(demo.violations(route) == "");
      }
    }
  }
}

}  // namespace

TEST_CASE("Every planner's routes are valid in the eyes of the checker, on whatever terrain") {
  check_every_planner({1u, 2u});
}

TEST_CASE("Every planner's routes are valid on further terrains", "[long]") {
  check_every_planner({3u, 7u, 20u, 34u});
}

TEST_CASE("Routes keep clear in their turns too, wide or narrow, close above the ground or not") {
  check_turns({1u});
}

TEST_CASE("Routes keep clear in their turns on further terrains", "[long]") {
  check_turns({3u, 6u});
}

TEST_CASE("Samplers give valid routes whatever their seed") {
  const Demo demo;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    PlannerOptions options;
    options.seed = seed;
    INFO("seed " << seed);
    const Route route = demo.plan("RRTConnect", options);
    CHECK(demo.violations(route) == "");
  }
}

TEST_CASE("The same seed gives the same route, another one another") {
  const Demo demo;
  const auto plan = [&](std::uint32_t seed) {
    PlannerOptions options;
    options.seed = seed;
    return demo.plan("RRTConnect", options).waypoints;
  };
  CHECK(plan(5) == plan(5));
  CHECK(plan(5) != plan(6));
}

TEST_CASE("RRTstar makes good use of more steps") {
  const Demo demo;
  const auto cost_after = [&](int looks) {
    return demo.cost_m(demo.plan("RRTstar", with_looks(looks)));
  };
  const double soon = cost_after(150);
  const double later = cost_after(3000);
  CHECK(later < soon);
  CHECK(later < 1.05 * demo.cost_m(demo.plan("AStar")));
}

TEST_CASE(
    "Whoever improves his route while there is time makes a valid one that is worth the time") {
  const Demo demo;
  const double best = demo.cost_m(demo.plan("AStar"));
  for (const std::string name : {"InformedRRTstar", "PRMstar"}) {
    INFO(name);
    const Route route = demo.plan(name, with_looks(4000));
    CHECK(demo.violations(route) == "");
    CHECK(route.planner == name);
    CHECK(demo.cost_m(route) < 1.2 * best);
  }
}

TEST_CASE("No planner has a thread of its library's, on which an exception would end the process") {
  const Demo demo;
  const auto threads = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  const auto before = threads();
  for (const std::string name : {"RRTConnect", "RRTstar", "InformedRRTstar", "PRMstar"}) {
    INFO(name);
    PlannerOptions options;
    int left = 200;
    auto most = before;
    options.now = [&] {
      most = std::max(most, threads());
      return skein::Instant(std::chrono::hours(--left > 0 ? 0 : 1));
    };
    try {
      demo.plan(name, options);
    } catch (const NoRoute&) {  // in so few looks at the clock
    }
    CHECK(most == before);
  }
}

TEST_CASE("LegacyDubins makes a valid route or none, or takes its process with it") {
  const pid_t child = ::fork();
  if (child == 0) {
    Demo demo;
    demo.problem.time_limit_ms = 1500;
    int result = 0;
    try {
      const Route route = demo.plan("LegacyDubins");
      result = demo.violations(route).empty() ? 0 : 1;
    } catch (const NoRoute& refusal) {
      result = refusal.proven ? 2 : 0;
    }
    std::_Exit(result);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  const bool aborted = WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT;
  CHECK((aborted || (WIFEXITED(status) && WEXITSTATUS(status) == 0)));
}

TEST_CASE("Each planner brings its routes as it finds them, the last being the best") {
  struct Routes final : skein::StreamSink<Route> {
    bool put(Route route, bool) override {
      found.push_back(std::move(route));
      return true;
    }
    std::vector<Route> found;
  };
  Demo demo;
  demo.problem.time_limit_ms = 20000;
  for (const std::string name : {"AStar", "RRTConnect"}) {
    Routes routes;
    make_planner(name, demo.terrains)->improve(demo.problem, routes);
    CHECK(routes.found.size() == 1);
  }
  demo.problem.time_limit_ms = 0;
  Routes routes;
  make_planner("RRTstar", demo.terrains, with_looks(3000))->improve(demo.problem, routes);
  REQUIRE(routes.found.size() > 1);
  for (const Route& route : routes.found) CHECK(demo.violations(route) == "");
  CHECK(demo.cost_m(routes.found.back()) < demo.cost_m(routes.found.front()));
}

TEST_CASE(
    "Routes end where they should and fly no lower than allowed, also just above the minimum") {
  Demo demo;
  demo.problem.start.altitude_m -= 128;
  demo.problem.goal.altitude_m -= 128;
  const Route route = demo.plan("AStar");
  CHECK(route.waypoints.front() == demo.problem.start);
  CHECK(route.waypoints.back() == demo.problem.goal);
  CHECK(demo.violations(route) == "");
}

TEST_CASE("An aircraft that turns on the spot needs no arcs, a faster one longer ones") {
  Demo demo;
  demo.problem.limits.maximum_bank_angle_deg = 0;
  const Route nimble = demo.plan("AStar");
  CHECK(demo.violations(nimble) == "");
  demo.problem.limits.maximum_bank_angle_deg = 30;
  demo.problem.limits.speed_m_s = 100;
  const Route fast = demo.plan("AStar");
  CHECK(demo.violations(fast) == "");
  CHECK(demo.cost_m(nimble) < 1.005 * demo.cost_m(fast));
}

TEST_CASE("A planner that is told to stop ends with NoRoute and says so") {
  for (const std::string& name : planner_names()) {
    const Demo demo;
    PlannerOptions options;
    options.stop = [] { return true; };
    INFO(name);
    const NoRoute refusal = refusal_of([&] { demo.plan(name, options); });
    CHECK_THAT(refusal.reason, Catch::Contains("stopped"));
    CHECK_FALSE(refusal.proven);
  }
}

TEST_CASE("By default a planner stops with the call that it works for") {
  const Demo demo;
  const skein::ManualClock clock;
  const std::atomic<bool> cancelled{true};
  const skein::CallContext context(clock, clock.now() + std::chrono::hours(1), {}, {}, nullptr,
                                   &cancelled);
  const skein::CallContextScope scope(context);
  CHECK(current_call_cancelled());
  CHECK_THROWS_AS(demo.plan("AStar"), NoRoute);
}

TEST_CASE("A planner whose time is up ends with NoRoute and names the limit") {
  for (const std::string& name : planner_names()) {
    Demo demo;
    demo.problem.time_limit_ms = 40;
    PlannerOptions options;
    int looks = 0;
    options.now = [&] { return skein::Instant(std::chrono::milliseconds(++looks * 10)); };
    INFO(name);
    const NoRoute refusal = refusal_of([&] { demo.plan(name, options); });
    CHECK_THAT(refusal.reason, Catch::Contains("40 ms"));
    CHECK_FALSE(refusal.proven);
  }
}

TEST_CASE("A planner that improves its route answers with the best so far when its time is up") {
  Demo demo;
  demo.problem.time_limit_ms = 60'000;
  for (const std::string name : {"RRTstar", "InformedRRTstar"}) {
    INFO(name);
    // Time is counted in looks at the clock. The search takes all but what its last path needs to
    // become a route.
    PlannerOptions options;
    int looks = 0;
    options.now = [&] { return skein::Instant(std::chrono::milliseconds(++looks * 20)); };
    const Route route = demo.plan(name, options);
    CHECK(demo.violations(route) == "");
  }
}

TEST_CASE("A planner that is stopped while it improves its route answers with the best so far") {
  const Demo demo;
  for (const std::string name : {"RRTstar", "InformedRRTstar"}) {
    INFO(name);
    struct FirstRoute final : skein::StreamSink<Route> {
      bool put(Route, bool) override { return there = true; }
      bool there = false;
    } routes;
    PlannerOptions options;
    options.now = [] { return skein::Instant(); };
    options.stop = [&] { return routes.there; };
    CHECK_NOTHROW(make_planner(name, demo.terrains, options)->improve(demo.problem, routes));
    CHECK(routes.there);
  }
}

TEST_CASE("A planner ends when its time is up, however hard the problem") {
  FlatCrossing crossing;
  Problem& problem = crossing.problem;
  problem.time_limit_ms = 200;
  const auto wall = [](const char* name, double south_m, double north_m) {
    return AE_navigator::NoFlyZone{
        name, {{south_m, 54000}, {north_m, 54000}, {north_m, 56000}, {south_m, 56000}}, 0, 0, 9000};
  };
  SECTION("no way through") { problem.no_fly_zones = {wall("Wall", -1000, 112000)}; }
  SECTION("a narrow gap far away") {
    problem.no_fly_zones = {wall("South", -1000, 90000), wall("North", 90300, 112000)};
  }
  SECTION("a start that is boxed in") {
    for (const double corner : {-2000.0, 2000.0}) {
      const double north = problem.start.north_m;
      const double east = problem.start.east_m;
      problem.no_fly_zones.push_back(
          {"Bar", {{north + corner, east - 2000}, {north + corner, east + 2000}}, 300, 0, 9000});
      problem.no_fly_zones.push_back(
          {"Bar", {{north - 2000, east + corner}, {north + 2000, east + corner}}, 300, 0, 9000});
    }
  }
  SECTION("a path that can be made better by no more than a trifle") {
    problem.radar_sites = {{"Faint", {100000, 60000}, 3000, 1000, 1e-3}};
  }
  for (const std::string& name : planner_names()) {
    INFO(name);
    const auto begin = thread_time();
    try {
      make_planner(name, crossing.terrains)->plan(problem);
    } catch (const NoRoute&) {
    }
    CHECK(thread_time() - begin < std::chrono::milliseconds(200 + 2000));
  }
}

TEST_CASE("One planner serves several threads at once") {
  const Demo demo;
  const auto planner = make_planner("AStar", demo.terrains);
  std::vector<Route> routes(3);
  std::vector<std::thread> threads;
  for (Route& route : routes) {
    threads.emplace_back([&] { route = planner->plan(demo.problem); });
  }
  for (auto& thread : threads) thread.join();
  for (const Route& route : routes) CHECK(route.waypoints == routes[0].waypoints);
}

TEST_CASE("An unknown planner is refused with the nearest that there is") {
  const auto terrains = std::make_shared<TerrainProvider>();
  CHECK_THROWS_WITH(make_planner("RRTStar", terrains),
                    Catch::Contains("'RRTStar'") && Catch::Contains("'RRTstar'"));
  CHECK_THROWS_AS(make_planner("", terrains), skein::InvalidArgument);
}
