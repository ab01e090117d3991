#include "sensing/collection.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "skein/evaluation.hpp"

namespace collection_test {

using namespace reconnaissance;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
const Camera kCamera{4 * kDegree, 3 * kDegree, 1920, 1440};
const CameraMount kMount;
const Flyby kFlyby{800, 1000, 60, 0};
const Objective kPoint{{{5000, 3000, 100}}, 20};
const Objective kWidePoint{{{5000, 3000, 100}}, 200};
/// 3 km to the north, then 4 km to the east.
const Objective kRoad{{{0, 0, 0}, {3000, 0, 30}, {3000, 4000, 70}}, 20};

double flat(double, double) { return 0; }

/// Where the aircraft is on its flight north past the origin, to the east of it (the camera looks
/// left), at a time of the plan.
CameraPose pose_at(const CollectionPlan& plan, const Flyby& flyby, double time_s,
                   const Local& aim) {
  const Local aircraft{flyby.speed_m_s * (time_s - plan.early_s), flyby.offset_m, flyby.height_m};
  return {aircraft, {}, point_at(aircraft, {}, aim)};
}

/// Where a plan aims at a time; nullopt while it moves.
std::optional<Local> aim_at(const CollectionPlan& plan, double time_s) {
  for (const Pointing& pointing : plan.pointings) {
    const double share = (time_s - pointing.begin_s) / pointing.seconds;
    if (share < 0 || share > 1) continue;
    return Local{std::lerp(pointing.from.north_m, pointing.to.north_m, share),
                 std::lerp(pointing.from.east_m, pointing.to.east_m, share),
                 std::lerp(pointing.from.height_m, pointing.to.height_m, share)};
  }
  return std::nullopt;
}

using Planner = std::function<std::optional<CollectionPlan>(const Objective&, const Flyby&,
                                                            const Camera&, const CameraMount&)>;

/// Flies a plan, frame by frame, and finds out which of the places have been seen, and how coarsely
/// at worst.
struct Flown {
  std::size_t seen = 0;
  double coarsest_m = 0;
};
Flown fly(const CollectionPlan& plan, const Flyby& flyby, const std::vector<Local>& places) {
  std::vector<bool> seen(places.size());
  Flown flown;
  for (double time_s = 0; time_s <= plan.seconds; time_s += 0.1) {
    const auto aim = aim_at(plan, time_s);
    if (!aim) continue;
    const CameraPose pose = pose_at(plan, flyby, time_s, *aim);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto point = in_image(pose, kCamera, places[i]);
      if (point) seen[i] = true;
    }
    const auto sample = ground_sample(pose, kCamera, {}, flat);
    REQUIRE(sample);
    flown.coarsest_m = std::max(flown.coarsest_m, sample->distance_m());
  }
  flown.seen = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
  return flown;
}

std::vector<Local> grid(double half_north_m, double half_east_m) {
  std::vector<Local> places;
  for (double share_n = -1; share_n <= 1; share_n += 0.05) {
    for (double share_e = -1; share_e <= 1; share_e += 0.1) {
      places.push_back({share_n * half_north_m, share_e * half_east_m, 0});
    }
  }
  return places;
}

}  // namespace

TEST_CASE("A point that fits into a frame is one aim for each, in the time of its movements") {
  const auto spot = plan_spot(kPoint, kFlyby, kCamera, kMount);
  const auto steps = plan_step_stare(kPoint, kFlyby, kCamera, kMount);
  REQUIRE((spot && steps));
  CHECK(spot->coverage == 1);
  CHECK(spot->seconds == Approx(3.3));
  CHECK(spot->pointings.size() == 1);
  CHECK(spot->pointings[0].from.north_m == 5000);
  CHECK(spot->pointings[0].from.height_m == 100);
  CHECK(steps->pointings.size() == 1);
  CHECK(steps->seconds == Approx(0.8));
  // At 99 m to the side: sqrt(800^2 + 1020^2 + 99^2) m and a grazing angle by it.
  const double slant = std::sqrt(800.0 * 800 + 1020.0 * 1020 + 99.0 * 99);
  CHECK(spot->sample_distance_m ==
        Approx(slant * 2 * std::tan(1.5 * kDegree) / 1440 * slant / 800));
}

TEST_CASE("Steps cover a wide point in as many frames as its size needs") {
  // From a helicopter, so that frames do not turn.
  const auto plan = plan_step_stare(kWidePoint, {800, 1000, 0.01, 0}, kCamera, kMount);
  REQUIRE(plan);
  // Its nearest part is 800 m aside, 45 degrees below the horizon.
  const double below = 45 * kDegree + 1.5 * kDegree;
  const double depth = 2 * (800 - 800 / std::tan(below));
  const double width = 2 * std::tan(2 * kDegree) * 800 / std::sin(below) * std::cos(1.5 * kDegree);
  const double rows = 1 + std::ceil((400 - depth) / (0.8 * depth));
  const double columns = 1 + std::ceil((400 - width) / (0.8 * width));
  CHECK(static_cast<double>(plan->pointings.size()) == rows * columns);
  CHECK(plan->coverage == 1);
}

TEST_CASE("Between steps are the movement, and the time that it takes to settle") {
  const Objective wide{{{5000, 3000, 100}}, 100};
  const auto plan = plan_step_stare(wide, kFlyby, kCamera, kMount);
  REQUIRE(plan);
  CHECK(plan->pointings[0].begin_s == Approx(0.3));
  for (std::size_t i = 1; i < plan->pointings.size(); ++i) {
    const Pointing& before = plan->pointings[i - 1];
    const Pointing& now = plan->pointings[i];
    const double slew_s = slant_range_m(before.to, now.from) / std::hypot(800, 1000);
    CHECK(now.begin_s == Approx(before.begin_s + before.seconds + slew_s + 0.3));
    CHECK(slant_range_m(before.to, now.from) < 110);  // To a neighbour.
  }
  CHECK(plan->seconds == Approx(plan->pointings.back().begin_s + 0.5));
  CHECK(plan->early_s == plan->seconds / 2);
}

TEST_CASE("Flown, steps and scans see all of the objective, and nothing coarser than they say") {
  const Objective wide{{{0, 0, 0}}, 100};
  const Objective straight_road{{{-2000, 0, 0}, {2000, 0, 0}}, 40};
  const Objective wide_road{{{-500, 0, 0}, {500, 0, 0}}, 90};
  for (const Planner& plan_it : {Planner(plan_step_stare), Planner(plan_line_scan)}) {
    for (const Objective* objective : {&wide, &straight_road, &wide_road}) {
      const auto plan = plan_it(*objective, kFlyby, kCamera, kMount);
      REQUIRE(plan);
      const double half_m = -objective->line.front().north_m + objective->margin_m;
      const auto places = grid(half_m, objective->margin_m);
      const Flown flown = fly(*plan, kFlyby, places);
      INFO("seconds " << plan->seconds << ", coarsest " << flown.coarsest_m << " said "
                      << plan->sample_distance_m);
      CHECK(flown.seen == places.size());
      CHECK(flown.coarsest_m <= plan->sample_distance_m * 1.01);
      CHECK(flown.coarsest_m > 0.7 * plan->sample_distance_m);
    }
  }
}

TEST_CASE("A spot sees of a road what fits into its frame") {
  const Objective straight_road{{{-2000, 0, 0}, {2000, 0, 0}}, 0};
  const auto plan = plan_spot(straight_road, kFlyby, kCamera, kMount);
  REQUIRE(plan);
  CHECK(plan->coverage < 0.03);
  std::vector<Local> places;
  for (double north = -2000; north <= 2000; north += 1) places.push_back({north, 0, 0});
  const auto seen = static_cast<double>(fly(*plan, kFlyby, places).seen);
  CHECK(seen / 4001 >= plan->coverage);
  CHECK(seen / 4001 < 1.25 * plan->coverage);  // The frame is larger than it shows for certain.
}

TEST_CASE("A scan is as fast as the aircraft, unless smear, the mount or the frames hold it up") {
  const auto seconds = [](const CameraMount& mount) {
    const auto plan = plan_line_scan(kRoad, kFlyby, kCamera, mount);
    REQUIRE(plan);
    return plan->seconds;
  };
  // 7 km, and 20 m at each end.
  CHECK(seconds(kMount) == Approx(0.3 + 7040 / 60.0));
  const double slant = std::hypot(800, 1000);
  const double sample = slant * 2 * std::tan(1.5 * kDegree) / 1440 * slant / 800;
  CameraMount dark = kMount;
  dark.integration_s = 1e-3;
  CHECK(seconds(dark) == Approx(0.3 + 7040 / (0.5 * sample / 1e-3)));
  CameraMount slow = kMount;
  slow.slew_rad_s = 0.04;
  CHECK(seconds(slow) == Approx(0.3 + 7040 / (0.04 * slant)));
  CameraMount rare = kMount;
  rare.frames_per_s = 0.8;
  CHECK(seconds(rare) > seconds(kMount));
  CHECK(plan_line_scan(kRoad, kFlyby, kCamera, kMount)->sample_distance_m ==
        Approx(std::hypot(1, 0.5) * sample * (800.0 * 800 + 1020 * 1020 + 9 * 9) /
               (800.0 * 800 + 1000 * 1000))
            .epsilon(1e-4));
}

TEST_CASE("Aims follow the road's bends and heights") {
  const auto scan = plan_line_scan(kRoad, kFlyby, kCamera, kMount);
  REQUIRE(scan);
  REQUIRE(scan->pointings.size() == 2);
  CHECK(scan->pointings[0].from.north_m == Approx(-20));
  CHECK(scan->pointings[0].to.north_m == Approx(3000));
  CHECK(scan->pointings[0].to.height_m == Approx(30));
  CHECK(scan->pointings[1].to.east_m == Approx(4020));
  CHECK(scan->pointings[1].to.north_m == Approx(3000));
  CHECK(scan->pointings[1].begin_s ==
        Approx(scan->pointings[0].begin_s + scan->pointings[0].seconds));
  const auto steps = plan_step_stare(kRoad, kFlyby, kCamera, kMount);
  REQUIRE(steps);
  for (const Pointing& step : steps->pointings) {
    const bool on_first = std::abs(step.from.east_m) < 1e-6;
    const bool on_second = std::abs(step.from.north_m - 3000) < 1e-6;
    CHECK((on_first || on_second));
  }
  CHECK(plan_spot(kRoad, kFlyby, kCamera, kMount)->pointings[0].from.east_m == Approx(500));
}

TEST_CASE("A wide road is scanned to and fro") {
  const auto plan = plan_line_scan({kRoad.line, 90}, kFlyby, kCamera, kMount);
  REQUIRE(plan);
  CHECK(plan->pointings.size() > 2);
  for (std::size_t i = 1; i < plan->pointings.size(); ++i) {
    CHECK(slant_range_m(plan->pointings[i - 1].to, plan->pointings[i].from) < 200);
  }
}

TEST_CASE("Along a road steps wait for the aircraft") {
  const auto plan = plan_step_stare(kRoad, kFlyby, kCamera, kMount);
  REQUIRE(plan);
  CHECK(plan->seconds == Approx(7040 / 60.0));
  // A fifth of the speed: five times the time.
  CHECK(plan_step_stare(kRoad, {800, 1000, 12, 0}, kCamera, kMount)->seconds ==
        Approx(7040 / 12.0));
}

TEST_CASE("Who looks at the horizon has no plan, nor who flies past too fast to step") {
  const Flyby low{50, 3000, 60, 0};
  CHECK_FALSE(plan_spot(kPoint, low, kCamera, kMount));
  CHECK_FALSE(plan_step_stare(kPoint, low, kCamera, kMount));
  CHECK_FALSE(plan_line_scan(kPoint, low, kCamera, kMount));
  CHECK(plan_spot(kPoint, {500, 0, 60, 0}, kCamera, kMount));
  CHECK_FALSE(plan_step_stare(kWidePoint, {800, 1000, 2000, 0}, kCamera, kMount));
}

TEST_CASE("The cheapest plan depends on what is to be seen, and on the camera") {
  CameraMount mount = kMount;
  mount.integration_s = 2e-4;
  const auto choose = [&](const Objective& objective, const Camera& camera) {
    const auto best = skein::best_by_cost<CollectionPlan>(
        [](const CollectionPlan& plan) { return collection_cost(plan, 0.3); });
    std::vector<skein::Opinion<CollectionPlan>> plans;
    const std::pair<const char*, Planner> planners[]{
        {"spot", plan_spot}, {"step-stare", plan_step_stare}, {"line scan", plan_line_scan}};
    for (const auto& [name, planner] : planners) {
      if (const auto plan = planner(objective, kFlyby, camera, mount)) {
        plans.push_back({name, *plan});
      }
    }
    const std::string how = best(plans)->how;
    return how.substr(0, how.find(" costs"));
  };
  const Camera narrow{1.5 * kDegree, 1.1 * kDegree, 1920, 1440};
  CHECK(choose(kPoint, kCamera) == "step-stare");
  CHECK(choose(kWidePoint, kCamera) == "line scan");
  CHECK(choose(kRoad, kCamera) == "step-stare");
  CHECK(choose({kRoad.line, 10}, narrow) == "line scan");
  CHECK(collection_cost({{}, 3, 1, 0.5, 0.6}, 0.3) == 3 + 500 + 1000);
}

TEST_CASE("a look that stays with a target aims at where it will be") {
  const Local place{5000, 3000, 100};
  const auto plan = plan_watch(place, 2, -8, kFlyby, kCamera);
  REQUIRE(plan);
  CHECK(aim_at(*plan, 0)->north_m == 5000);
  CHECK(aim_at(*plan, 1)->north_m == Approx(5002));
  CHECK(aim_at(*plan, 1)->east_m == Approx(2992));
  CHECK(plan->coverage == 1);
  CHECK(plan->sample_distance_m ==
        Approx(plan_spot({{place}, 0}, kFlyby, kCamera, kMount)->sample_distance_m).epsilon(0.05));
  CHECK_FALSE(plan_watch(place, 0, 0, {800, 60000, 60, 0}, kCamera));
}

}  // namespace collection_test
