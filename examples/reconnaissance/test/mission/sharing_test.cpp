#include "mission/sharing.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "random.hpp"
#include "skein/error.hpp"

namespace sharing_test {

using namespace reconnaissance;

namespace {

using Shares = std::vector<std::size_t>;

double sum_m(const std::vector<Local>& places, const std::vector<Local>& starts,
             const Shares& shares) {
  double sum = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    sum += map_distance_m(places[i], starts[shares[i]]);
  return sum;
}

}  // namespace

TEST_CASE("Each aircraft takes the places that are on its side") {
  const std::vector<Local> starts{{0, 0}, {4000, 0}};
  CHECK(share_out({{9000, 0}, {-5000, 0}, {8000, 3000}, {-2000, 9000}}, starts) ==
        Shares{1, 0, 1, 0});
}

TEST_CASE(
    "Each takes as many as the other, and a third one that is nearer to the other if it must") {
  const std::vector<Local> starts{{0, 0}, {4000, 0}};
  const std::vector<Local> places{{9000, 0},    {8000, 0},  {7000, 0},
                                  {2100, 9000}, {-1000, 0}, {0, -1}};
  const Shares shares = share_out(places, starts);
  CHECK(std::ranges::count(shares, 0) == 3);
  // It costs least to give the first aircraft the one that is hardly nearer to the second.
  CHECK(shares == Shares{1, 1, 1, 0, 0, 0});
}

TEST_CASE("Of an odd number one has one more, whichever costs less") {
  const std::vector<Local> starts{{0, 0}, {4000, 0}};
  CHECK(share_out({{5000, 0}, {4500, 0}, {100, 0}}, starts) == Shares{1, 1, 0});
  CHECK(share_out({{-100, 0}, {4500, 0}, {100, 0}}, starts) == Shares{0, 1, 0});
  CHECK(share_out({{5000, 0}}, starts) == Shares{1});
  CHECK(share_out({}, starts).empty());
}

TEST_CASE("All who ask have the same answer: equally good ones go to the first") {
  CHECK(share_out({{10, 0}, {10, 0}}, {{0, 0}, {0, 0}}) == Shares{0, 1});
  CHECK(share_out({{10, 0}}, {{0, 0}, {0, 0}}) == Shares{0});
}

TEST_CASE("No other share of random places is shorter") {
  Random random(3);
  const auto anywhere = [&] { return Local{1e4 * random.normal(), 1e4 * random.normal(), 0}; };
  for (int run = 0; run < 20; ++run) {
    const std::vector<Local> starts{anywhere(), anywhere(), anywhere()};
    std::vector<Local> places;
    for (int i = 0; i < 7; ++i) places.push_back(anywhere());
    const double found_m = sum_m(places, starts, share_out(places, starts));
    double least_m = 1e12;
    for (int code = 0; code < 3 * 3 * 3 * 3 * 3 * 3 * 3; ++code) {
      Shares shares;
      for (int i = 0, rest = code; i < 7; ++i, rest /= 3)
        shares.push_back(static_cast<std::size_t>(rest % 3));
      const auto with = [&](std::size_t i) { return std::ranges::count(shares, i); };
      if (std::min({with(0), with(1), with(2)}) < 2) continue;
      least_m = std::min(least_m, sum_m(places, starts, shares));
    }
    CHECK(found_m == Approx(least_m));
  }
}

TEST_CASE("Without aircraft nothing can be shared out") {
  CHECK_THROWS_AS(share_out({{0, 0}}, {}), skein::InvalidArgument);
}

TEST_CASE("Every element is in the share of one aircraft, by its middle") {
  const auto elements = parse_elements(
      "near 1 3 0.3 30 53.30 27.41; road 1 3 0.3 30 53.30 27.42 53.44 27.42; far 1 3 0.3 30 53.50 "
      "27.4");
  const std::vector<Geodetic> starts{{53.30, 27.4, 180}, {53.36, 27.4, 180}};
  const auto names = [&](std::size_t aircraft) {
    std::vector<std::string> result;
    for (const ElementText& each : share_of(elements, starts, aircraft))
      result.push_back(each.name);
    return result;
  };
  CHECK(names(0) == std::vector<std::string>{"near"});
  CHECK(names(1) == std::vector<std::string>{"road", "far"});
  CHECK_THROWS_AS(share_of(elements, starts, 2), skein::InvalidArgument);
}

}  // namespace sharing_test
