#include "sensing/image_quality.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace image_quality_test {

using namespace reconnaissance;

namespace {

GroundSample square(double metres) { return {{}, 1000, 1, metres, metres}; }

}  // namespace

TEST_CASE(
    "An image's rating is that of the published test case, and agrees with the scale's table") {
  // NGA, GIQE 5, figure 1: 20.8 inches, RER 0.35, SNR 50 rate 5.
  CHECK(niirs(square(0.52832), {0.35, 50}) == Approx(5).margin(0.02));
  // Half the distance is worth one level.
  CHECK(niirs(square(0.26416), {0.35, 50}) == Approx(6).margin(0.02));
  // The scale by ground resolved distance, two samples (Imagery Resolution Assessments and
  // Reporting Standards Committee, National Imagery Interpretability Rating Scale, 1994): level 4
  // from 2.5 m to 1.2 m, 5 to 0.75 m, 6 to 0.40 m, 7 to 0.20 m.
  const struct {
    int level;
    double coarsest_m;
    double finest_m;
  } levels[]{{4, 2.5, 1.2}, {5, 1.2, 0.75}, {6, 0.75, 0.40}, {7, 0.40, 0.20}};
  for (const auto& [level, coarsest_m, finest_m] : levels) {
    const double middle_m = std::sqrt(coarsest_m * finest_m) / 2;
    INFO("level " << level << " by equation " << niirs(square(middle_m)));
    CHECK(std::abs(niirs(square(middle_m)) - level) < 0.5);
  }
  CHECK(niirs(square(100)) == 0);
  CHECK(niirs(square(0.3), {0.9, 50}) > niirs(square(0.3), {0.3, 50}));
}

TEST_CASE("Collected is what has 0.3 m a pixel in both directions") {
  CHECK(is_collected({{}, 1000, 1, 0.2, 0.3}));
  CHECK_FALSE(is_collected({{}, 1000, 1, 0.2, 0.301}));
}

}  // namespace image_quality_test
