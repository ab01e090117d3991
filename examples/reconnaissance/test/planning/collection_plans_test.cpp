#include <catch2/catch.hpp>

#include "collection_scene.hpp"

namespace collection_plans_test {

using namespace reconnaissance;

namespace {

bool always() { return true; }

/// Tries every order of every subset with every pass.
void try_all(const Scene& scene, const FlightCost& limits, CollectionTour plan, const RoutePose& at,
             CollectionTour& best) {
  const FlightCost so_far = plan.cost;
  plan.cost += scene.leg(at, scene.home);
  plan.feasible = covers(plan.cost, limits);
  if (plan.feasible && is_better(plan, best)) best = plan;
  for (std::size_t task = 0; task < scene.tasks.size(); ++task) {
    if (std::any_of(plan.collections.begin(), plan.collections.end(),
                    [&](const Collection& one) { return one.task == task; })) {
      continue;
    }
    for (std::size_t pass = 0; pass < scene.tasks[task].passes.size(); ++pass) {
      const CollectionPass& flown = scene.tasks[task].passes[pass];
      CollectionTour longer = plan;
      longer.cost = so_far + scene.leg(at, flown.begin) + flown.cost;
      longer.value += scene.tasks[task].value;
      longer.collections.push_back({task, pass});
      try_all(scene, limits, longer, flown.end, best);
    }
  }
}

/// From limits that allow nearly nothing to none.
std::vector<FlightLimits> some_limits() {
  const double kEver = std::numeric_limits<double>::infinity();
  return {{900, kEver, 0},      {1800, kEver, 0}, {2700, kEver, 0}, {kEver, 25, 0},
          {kEver, kEver, 0.97}, {2400, 24, 0.95}, {kEver, kEver, 0}};
}

}  // namespace

TEST_CASE("what an estimate exceeds is said with the limit, and decides") {
  const FlightLimits limits{2400, 60, 0.95};
  CHECK_FALSE(excess({2400, 60, -std::log(0.95)}, limits));
  CHECK_FALSE(excess({1e9, 1e9, 1e9}, {}));
  CHECK(excess({0, 0, 0.5}, limits) == "survives with a probability of 0.607, at least 0.950");
  CHECK(excess({2500, 0, 0}, limits) == "takes 2500 s, at most 2400");
  CHECK(excess({0, 61, 0}, limits) == "burns 61.0 kg, at most 60.0");
}

TEST_CASE("the exact plan is the best of all orders, subsets and passes") {
  int dropping = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    Scene scene = random_scene(seed, 4, 2);
    scene.arbitrary = seed > 8;
    for (const FlightLimits& limits : some_limits()) {
      CollectionTour best;
      try_all(scene, limits.most(), {}, scene.home, best);
      const CollectionTour exact = exact_plan(scene.problem(limits));
      CAPTURE(seed);
      CHECK(adds_up(scene, limits, exact));
      CHECK(exact.value == best.value);
      CHECK(exact.cost.seconds == Approx(best.cost.seconds));
      dropping += exact.collections.size() < scene.tasks.size();
    }
  }
  CHECK(dropping > 15);
}

TEST_CASE("branch and bound finds what the exact plan finds, and proves it") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Scene scene = random_scene(seed, 7, 4);
    scene.arbitrary = seed > 5;
    for (const FlightLimits& limits : some_limits()) {
      const CollectionProblem problem = scene.problem(limits);
      const CollectionTour exact = exact_plan(problem);
      const SearchedPlan searched = branch_and_bound_plan(problem, always);
      CAPTURE(seed);
      CHECK(searched.proven);
      CHECK(adds_up(scene, limits, searched.plan));
      CHECK(searched.plan.value == Approx(exact.value));
      CHECK(searched.plan.cost.seconds == Approx(exact.cost.seconds));
    }
  }
}

TEST_CASE("the heuristic plan is never better than the exact one, and seldom much worse") {
  int same = 0;
  int plans = 0;
  double worst_value = 1;
  double sum_value = 0;
  double worst_time = 1;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const Scene scene = random_scene(seed, 7, 4);
    for (const FlightLimits& limits : some_limits()) {
      const CollectionProblem problem = scene.problem(limits);
      const CollectionTour exact = exact_plan(problem);
      const CollectionTour heuristic = heuristic_plan(problem);
      CAPTURE(seed);
      CHECK(adds_up(scene, limits, heuristic));
      CHECK(heuristic.feasible == exact.feasible);
      CHECK(heuristic.value <= exact.value);
      if (exact.value == 0) continue;
      ++plans;
      sum_value += heuristic.value / exact.value;
      worst_value = std::min(worst_value, heuristic.value / exact.value);
      if (heuristic.value < exact.value) continue;
      ++same;
      CHECK(heuristic.cost.seconds >= exact.cost.seconds - 1e-6);
      worst_time = std::max(worst_time, heuristic.cost.seconds / exact.cost.seconds);
    }
  }
  CHECK(same > 0.95 * plans);
  CHECK(sum_value / plans > 0.99);
  CHECK(worst_value > 0.8);
  CHECK(worst_time < 1.1);
}

TEST_CASE("more time to think never gives a worse plan, and no time the heuristic one") {
  const Scene scene = random_scene(6, 11, 4);
  const FlightLimits limits{2700, 30, 0.95};
  const CollectionProblem problem = scene.problem(limits);
  const CollectionTour at_once = heuristic_plan(problem);
  CollectionTour before = at_once;
  for (const int budget : {0, 300, 3000, 30'000, 300'000}) {
    int left = budget;
    const SearchedPlan searched = branch_and_bound_plan(problem, [&] { return left-- > 0; });
    CHECK(left >= -1);
    CHECK(adds_up(scene, limits, searched.plan));
    CHECK(searched.plan.feasible);
    CHECK(!is_better(before, searched.plan));
    if (budget == 0) {
      CHECK(!searched.proven);
      CHECK(searched.plan.collections == before.collections);
    }
    before = searched.plan;
  }
  CHECK(is_better(before, at_once));
}

TEST_CASE("twenty tasks are planned, too") {
  const Scene scene = random_scene(5, 20, 4);
  const FlightLimits limits{3600, 45, 0.9};
  const CollectionProblem problem = scene.problem(limits);
  int left = 2000;
  const SearchedPlan searched = branch_and_bound_plan(problem, [&] { return left-- > 0; });
  CHECK(adds_up(scene, limits, searched.plan));
  CHECK(searched.plan.collections.size() >= 5);
  CHECK(!is_better(heuristic_plan(problem), searched.plan));
  CHECK_THROWS_AS(exact_plan(problem), std::invalid_argument);
}

TEST_CASE("when fuel is short, what is worth least for its way is dropped") {
  // Far away and worth little, near and worth little, far and worth much.
  Scene scene;
  scene.tasks = {{1, passes_over(0, 15'000, 8)},
                 {1, passes_over(3000, 0, 8)},
                 {5, passes_over(0, -15'000, 8)}};
  const FlightLimits enough{1e9, 20, 0};
  const auto all = exact_plan(scene.problem(enough));
  CHECK(all.collections.size() == 3);
  const FlightLimits scarce{1e9, 9, 0};
  const CollectionProblem problem = scene.problem(scarce);
  for (const CollectionTour& plan : {exact_plan(problem), heuristic_plan(problem),
                                     branch_and_bound_plan(problem, always).plan}) {
    REQUIRE(plan.collections.size() == 2);
    CHECK(plan.value == 6);
  }
}

TEST_CASE("when survival is short, what lies beside the radar is dropped") {
  Scene scene;
  scene.tasks = {{5, passes_over(0, 15'000, 8)}, {1, passes_over(3000, 0, 8)}};
  scene.sites = {{0, 15'000, 0}};
  const FlightLimits limits{1e9, 1e9, 0.95};
  const CollectionProblem problem = scene.problem(limits);
  const CollectionTour plan = exact_plan(problem);
  REQUIRE(plan.collections.size() == 1);
  CHECK(plan.collections[0].task == 1);
  CHECK(std::exp(-plan.cost.hazard) >= 0.95);
}

TEST_CASE("who cannot even reach the landing is told so") {
  Scene scene;
  scene.home = {0, 0, 0};
  scene.tasks = {{1, passes_over(1000, 0, 4)}};
  const CollectionProblem problem(
      {0, 0, 0}, {20'000, 0, 0}, scene.tasks,
      [&](const RoutePose& from, const RoutePose& to) { return scene.leg(from, to); },
      {100, 1e9, 0});
  CHECK(!exact_plan(problem).feasible);
  CHECK(!heuristic_plan(problem).feasible);
  CHECK(!branch_and_bound_plan(problem, always).plan.feasible);
}

TEST_CASE("a problem that makes no sense is refused") {
  const Scene scene = random_scene(1, 2, 2);
  const auto with = [&](std::vector<CollectionTask> tasks, const CollectionProblem::Leg& leg) {
    return CollectionProblem(scene.home, scene.home, std::move(tasks), leg, {});
  };
  const auto leg = [&](const RoutePose& from, const RoutePose& to) { return scene.leg(from, to); };
  CHECK_THROWS_AS(with({{1, {}}}, leg), std::invalid_argument);
  CHECK_THROWS_AS(with({{0, passes_over(0, 0, 2)}}, leg), std::invalid_argument);
  CHECK_THROWS_AS(with(scene.tasks,
                       [](auto&&, auto&&) {
                         return FlightCost{-1, 0, 0};
                       }),
                  std::invalid_argument);
  CHECK_THROWS_AS(with(std::vector<CollectionTask>(49, scene.tasks[0]), leg),
                  std::invalid_argument);
}

}  // namespace collection_plans_test
