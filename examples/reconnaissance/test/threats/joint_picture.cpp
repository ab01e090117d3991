#include "threats/joint_picture.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "random.hpp"

namespace joint_picture_test {

using namespace reconnaissance;
using skein::fusion::chi_square_quantile;
using skein::fusion::Estimate;
using skein::fusion::fuse_independent;
using skein::fusion::nees;

namespace {

constexpr int kRuns = 200;

/// Of the mean NEES of a place over all runs.
double bound(double probability) { return chi_square_quantile(probability, 2 * kRuns) / kRuns; }

const std::vector<double> kTruth{6000, 8000};

/// By bearings from the south: known across better than along.
Estimate from_the_south(Random& random) {
  return {{kTruth[0] + 600 * random.normal(), kTruth[1] + 150 * random.normal()},
          {600 * 600, 0, 0, 150 * 150}};
}
Estimate from_the_west(Random& random) {
  return {{kTruth[0] + 120 * random.normal(), kTruth[1] + 500 * random.normal()},
          {120 * 120, 0, 0, 500 * 500}};
}

Estimate at(double north_m, double east_m, double deviation_m = 100) {
  return {{north_m, east_m}, {deviation_m * deviation_m, 0, 0, deviation_m * deviation_m}};
}

const char* const kShort = "short-range site";

}  // namespace

TEST_CASE("A site that two aircraft report is one, placed better than by either") {
  Random random(5);
  JointPicture joint;
  const Estimate south = from_the_south(random), west = from_the_west(random);
  joint.report("uav-1", {{1, kShort, south}});
  joint.report("uav-2", {{4, kShort, west}});
  const auto sites = joint.sites();
  REQUIRE(sites.size() == 1);
  CHECK(sites[0].emitter == kShort);
  CHECK(sites[0].reporters == std::vector<std::string>{"uav-1", "uav-2"});
  const double deviation_m = greatest_deviation_m(sites[0].position);
  CHECK(deviation_m < 0.6 * greatest_deviation_m(south));
  CHECK(deviation_m < 0.6 * greatest_deviation_m(west));
}

TEST_CASE("What one aircraft alone has heard is in the picture as it reports it") {
  JointPicture joint;
  joint.report("uav-1", {{1, kShort, at(0, 0)}});
  joint.report("uav-2", {{1, kShort, at(9000, 0)}, {2, "medium-range site", at(0, 0)}});
  const auto sites = joint.sites();
  REQUIRE(sites.size() == 3);
  CHECK(sites[0].position.mean == std::vector<double>{0, 0});
  CHECK(sites[1].position.mean == std::vector<double>{9000, 0});
  CHECK(sites[2].emitter == "medium-range site");
  for (const auto& each : sites) CHECK(each.reporters.size() == 1);
}

TEST_CASE("Two sites of one aircraft are never one, and a report joins the nearer") {
  JointPicture joint;
  joint.report("uav-1", {{1, kShort, at(0, 0)}, {2, kShort, at(100, 0)}});
  joint.report("uav-2", {{7, kShort, at(90, 0)}});
  const auto sites = joint.sites();
  REQUIRE(sites.size() == 2);
  CHECK(sites[0].reporters == std::vector<std::string>{"uav-1"});
  CHECK(sites[1].reporters == std::vector<std::string>{"uav-1", "uav-2"});
}

TEST_CASE("A site keeps its number while its reports move, and one that is given up is gone") {
  JointPicture joint;
  joint.report("uav-1", {{2, kShort, at(5000, 0)}});
  const std::uint32_t id = joint.sites().at(0).id;
  joint.report("uav-1", {{1, kShort, at(-5000, 0)}, {2, kShort, at(5200, 50)}});
  joint.report("uav-2", {{9, kShort, at(5100, 0)}});
  const auto sites = joint.sites();
  REQUIRE(sites.size() == 2);
  CHECK(sites[1].id == id);
  CHECK(sites[0].id != id);
  joint.report("uav-1", {});
  REQUIRE(joint.sites().size() == 1);
  CHECK(joint.sites()[0].reporters == std::vector<std::string>{"uav-2"});
}

namespace {

/// The mean NEES of what an aircraft has after pictures have gone round: by intersection, and if
/// all that comes were taken for independent.
struct Rounds {
  double intersected = 0;
  double added = 0;
  double first_deviation_m = 0;  ///< By intersection, after the first round,
  double last_deviation_m = 0;   ///< and after the last.
};

Rounds go_round(int rounds, std::uint64_t seed) {
  Random random(seed);
  Rounds mean;
  for (int run = 0; run < kRuns; ++run) {
    const Estimate own[]{from_the_south(random), from_the_west(random)};
    Estimate pictures[]{own[0], own[1]}, added[]{own[0], own[1]};
    JointPicture joint;
    for (int round = 0; round < rounds; ++round) {
      joint.report("uav-1", {{1, kShort, own[0]}});
      joint.report("uav-2", {{1, kShort, own[1]}});
      const auto sites = joint.sites();
      if (sites.size() != 1) break;  // One in a hundred does not agree.
      const Estimate together = fuse_independent(added);
      for (int i = 0; i < 2; ++i) {
        const Estimate both[]{own[i], sites[0].position};
        pictures[i] = skein::fusion::intersect(both).fused;
        const Estimate again[]{added[i], together};
        added[i] = fuse_independent(again);
      }
      if (round == 0) mean.first_deviation_m += greatest_deviation_m(pictures[0]) / kRuns;
      if (round == rounds - 1) mean.last_deviation_m += greatest_deviation_m(pictures[0]) / kRuns;
    }
    mean.intersected += nees(pictures[0], kTruth) / kRuns;
    mean.added += nees(added[0], kTruth) / kRuns;
  }
  UNSCOPED_INFO("NEES " << mean.intersected << " by intersection, " << mean.added
                        << " added; at most " << bound(0.975));
  return mean;
}

}  // namespace

TEST_CASE(
    "However often pictures go round, nothing counts twice: by intersection they stay consistent, "
    "added as if they were independent they are overconfident") {
  const Rounds ten = go_round(10, 41);
  CHECK(ten.intersected < bound(0.975));
  CHECK(ten.added > 10 * bound(0.975));
  CHECK(ten.last_deviation_m == Approx(ten.first_deviation_m));
}

}  // namespace joint_picture_test
