#include "threats/sites.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "skein/error.hpp"
#include "threats/emitter_classification.hpp"

namespace sites_test {

using namespace reconnaissance;

namespace {

double flat(double, double) { return 0; }
double wall(double north_m, double) { return north_m > 1000 && north_m < 2000 ? 9000 : 0; }

/// As every aspect of a ball of a square metre.
const Ellipsoid kSquareMetre{0.5642, 0.5642, 0.5642};

}  // namespace

TEST_CASE("A site of each type sees a square metre from its distance on, and none but in sight") {
  for (const EmitterType& type : emitter_types()) {
    INFO(type.name);
    const RadarSite site = site_of_type(type.name, 1, {0, 0, 0}, 0);
    const auto probability = [&](double range_m, const GroundHeight& ground) {
      const double level_m = std::sqrt(range_m * range_m - 3000 * 3000);
      return look_probability(site, {{level_m, 0, 3010}, {}, kSquareMetre}, ground);
    };
    CHECK(probability(type.detection_m, flat) == Approx(0.9).margin(0.01));
    CHECK(probability(1.5 * type.detection_m, flat) < 0.1);
    CHECK(probability(type.detection_m, wall) == 0);
    CHECK((site.zone.kills_per_s > 0) == (type.lethal_m > 0));
  }
}

TEST_CASE("What a site transmits is taken for its type by the library") {
  for (const EmitterType& type : emitter_types()) {
    const RadarSite site = site_of_type(type.name, 1, {0, 0, 0}, 0);
    const Intercept intercept{0, 0, 0.035, site.search, 1e-6};
    INFO(type.name);
    CHECK(classify_bayesian(intercept, WarnerReceiver(), emitter_library()).emitter == type.name);
  }
}

TEST_CASE("A type that is unknown is refused with those that are known") {
  CHECK_THROWS_WITH(site_of_type("laser", 1, {}, 0), Catch::Contains("mobile gun"));
}

}  // namespace sites_test
