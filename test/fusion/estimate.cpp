#include "estimates.hpp"
#include "skein/error.hpp"
#include "skein/fusion.hpp"

using namespace skein::fusion;
using Catch::Contains;

TEST_CASE("an estimate that cannot be one is refused with what is wrong with it") {
  const auto fused = [](Estimate estimate) {
    const Estimate estimates[]{{{0, 0}, {1, 0, 0, 1}}, std::move(estimate)};
    return intersect(estimates);
  };
  CHECK_THROWS_WITH(fused({{1, 2}, {1, 0, 0}}), Contains("estimate 2 of 2") &&
                                                    Contains("a covariance of 4") &&
                                                    Contains("it has 3"));
  CHECK_THROWS_WITH(fused({{1, 2}, {1, 0.5, 0.4, 1}}), Contains("not symmetric"));
  CHECK_THROWS_WITH(fused({{1, 2}, {1, 2, 2, 1}}), Contains("not positive definite"));
  CHECK_THROWS_WITH(fused({{1, NAN}, {1, 0, 0, 1}}), Contains("not finite"));
  CHECK_THROWS_WITH(fused({{1, 2, 3}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}),
                    Contains("3 quantities") && Contains("2"));
  CHECK_THROWS_AS(intersect({}), skein::InvalidArgument);
}

TEST_CASE("what double cannot compute with is refused with its place and a remedy") {
  const auto refusal = [](const Estimate& estimate) {
    const std::vector<Estimate> estimates{{{0, 0}, {1, 0, 0, 1}}, estimate};
    CHECK_THROWS_AS(unite(estimates), skein::InvalidArgument);
    CHECK_THROWS_AS(fuse_cautiously(estimates), skein::InvalidArgument);
    CHECK_THROWS_AS(intersect(estimates), skein::InvalidArgument);
    CHECK_THROWS_AS(squared_distance(estimates[0], estimate), skein::InvalidArgument);
    CHECK_THROWS_AS(nees(estimate, {0, 0}), skein::InvalidArgument);
    try {
      fuse_independent(estimates);
    } catch (const skein::InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  CHECK_THAT(refusal({{0, 1e160}, {1, 0, 0, 1}}),
             Contains("estimate 2 of 2") && Contains("mean [1] is 1e+160") && Contains("unit"));
  CHECK_THAT(refusal({{0, 0}, {1e-310, 0, 0, 1}}),
             Contains("estimate 2 of 2") && Contains("variance [0]") && Contains("unit"));
  CHECK_THAT(refusal({{0, 0}, {1, 0, 0, 1e300}}), Contains("variance [1] is 1e+300"));
  CHECK_THAT(refusal({{0, 0}, {1, 1e308, 1e308, 1}}), Contains("not positive definite"));
  CHECK_THAT(refusal({{0, 0}, {1, 1 - 1e-14, 1 - 1e-14, 1}}),
             Contains("near to singular") && Contains("leave out"));
}

TEST_CASE("chi-square quantiles are those of the tables") {
  CHECK(chi_square_quantile(0.95, 1) == Approx(3.841).margin(5e-4));
  CHECK(chi_square_quantile(0.99, 2) == Approx(9.210).margin(5e-4));
  CHECK(chi_square_quantile(0.975, 10) == Approx(20.483).margin(5e-4));
  CHECK_THROWS_AS(chi_square_quantile(1, 2), skein::InvalidArgument);
  CHECK_THROWS_AS(chi_square_quantile(0.5, 0), skein::InvalidArgument);
  CHECK_THROWS_AS(chi_square_quantile(0.5, std::size_t{1} << 40), skein::InvalidArgument);
}

TEST_CASE("distances are measured in the errors that are to be expected") {
  const Estimate near{{0, 0}, {4, 0, 0, 1}};
  CHECK(squared_distance(near, {{3, 0}, {5, 0, 0, 1}}) == Approx(1));
  CHECK(nees(near, {4, 3}) == Approx(4 + 9));
  CHECK_THROWS_AS(nees(near, {4}), skein::InvalidArgument);
  CHECK_THROWS_WITH(nees(near, {4, NAN}), Contains("value [1] of the truth is nan"));
}
