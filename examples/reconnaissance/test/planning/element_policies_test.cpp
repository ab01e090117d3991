#include "planning/element_policies.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "geodesy/local_frame.hpp"
#include "random.hpp"

namespace element_policies_test {

using namespace reconnaissance;

TEST_CASE("the probability to be inside a circle is what random places show") {
  Random random(60);
  int inside = 0;
  constexpr int kPlaces = 20'000;
  for (int i = 0; i < kPlaces; ++i) {
    const double north = 30 * random.normal();
    inside += std::hypot(north, 30 * random.normal()) <= 50;
  }
  CHECK(inside_probability(30, 50) == Approx(inside / double(kPlaces)).margin(0.01));
  CHECK(inside_probability(0, 50) == 1);
}

TEST_CASE("what is unknown, or was seen too coarsely, is not fulfilled") {
  Element element;
  CHECK(!is_fulfilled(element));
  element.best_gsd_m = 0.3;
  CHECK(is_fulfilled(element));
  element.deviation_m = 21;
  CHECK(!is_fulfilled(element));
  element.deviation_m = 0;
  element.best_gsd_m = 0.4;
  CHECK(!is_fulfilled(element));
}

TEST_CASE("an element is known if it is identified and within twice the wanted deviation") {
  Element element;
  element.best_gsd_m = element.size_m / 2 / 6.4;
  element.deviation_m = element.wanted_deviation_m;
  CHECK(known_probability(element) == Approx(0.5 * (1 - std::exp(-2.0))));
  element.deviation_m = 2 * element.wanted_deviation_m;
  CHECK(known_probability(element) == Approx(0.5 * (1 - std::exp(-0.5))));
}

TEST_CASE("the value of a look grows with what is not known, and never is negative") {
  Random random(61);
  for (int i = 0; i < 2000; ++i) {
    Element element;
    element.priority = 10 * random.uniform();
    element.deviation_m = 200 * random.uniform();
    element.best_gsd_m =
        random.happens(0.3) ? std::numeric_limits<double>::infinity() : 0.1 + random.uniform();
    const Look look{600 * random.uniform(), 0.1 + random.uniform(), 20 * random.uniform(),
                    50 + 200 * random.uniform()};
    const double value = value_of_look(element, look);
    REQUIRE(value >= 0);
    REQUIRE(value <= element.priority);
    Look finer = look;
    finer.gsd_m /= 2;
    REQUIRE(value_of_look(element, finer) >= value);
    Element known_better = element;
    known_better.best_gsd_m = std::min(element.best_gsd_m, look.gsd_m);
    REQUIRE(value_of_look(known_better, look) <= value + 1e-12);
  }
}

TEST_CASE("by priority the most important comes first, of equals the soonest, fulfilled ones not") {
  std::vector<Element> elements(4);
  elements[0].priority = 1;
  elements[1].priority = 5;
  elements[2].priority = 5;
  elements[3].priority = 9;
  elements[3].best_gsd_m = 0.1;
  std::vector<std::optional<Look>> looks{Look{10}, Look{300}, Look{200}, Look{10}};
  CHECK(next_by_priority(elements, looks) == 2);
  looks[2].reset();
  CHECK(next_by_priority(elements, looks) == 1);
  looks[1].reset();
  looks[0].reset();
  CHECK(!next_by_priority(elements, looks));
  CHECK(!next_by_priority({}, {}));
}

TEST_CASE("by value the near one comes before the somewhat more important far one") {
  std::vector<Element> elements(2);
  elements[0].priority = 4;
  elements[1].priority = 5;
  const std::vector<std::optional<Look>> looks{Look{60}, Look{600}};
  CHECK(next_by_value(elements, looks) == 0);
  CHECK(next_by_priority(elements, looks) == 1);
}

TEST_CASE("by value a fulfilled element is not looked at again") {
  Element element;
  element.best_gsd_m = 0.15;
  element.deviation_m = 5;
  CHECK(!next_by_value({element}, {Look{60, 0.15}}));
}

TEST_CASE("by value no time goes to what a look would hardly find or hardly resolve") {
  std::vector<Element> elements(1);
  elements[0].deviation_m = 5000;
  CHECK(!next_by_value(elements, {Look{60}}));
  CHECK(next_by_priority(elements, {Look{60}}) == 0);
  elements[0].deviation_m = 5;
  CHECK(!next_by_value(elements, {Look{60, 5.0}}));
}

namespace {

using Policy = std::function<std::optional<std::size_t>(const std::vector<Element>&,
                                                        const std::vector<std::optional<Look>>&)>;

/// Priority · known, over all elements, after 20 minutes at 60 m/s.
double flown(std::uint64_t seed, const Policy& policy) {
  Random random(seed);
  struct Place {
    double north_m, east_m;
  };
  std::vector<Element> elements(10);
  std::vector<Place> places;
  for (Element& element : elements) {
    element.priority = 1 + std::floor(9 * random.uniform());
    element.deviation_m = 20 + 60 * random.uniform();
    const double north = 30'000 * random.uniform();
    places.push_back({north, 30'000 * random.uniform()});
  }
  Place at{0, 0};
  double now_s = 0;
  while (true) {
    std::vector<std::optional<Look>> looks;
    for (const Place& place : places) {
      const double seconds = 30 + map_distance_m(place, at) / 60;
      looks.push_back(now_s + seconds <= 1200 ? std::optional(Look{seconds, 0.2, 5, 150})
                                              : std::nullopt);
    }
    const auto next = policy(elements, looks);
    if (!next) break;
    now_s += looks[*next]->seconds;
    at = places[*next];
    Element& element = elements[*next];
    if (random.happens(inside_probability(element.deviation_m, 150))) {
      element.best_gsd_m = 0.2;
      element.deviation_m = 5;
    }
  }
  double sum = 0;
  for (const Element& element : elements) sum += element.priority * known_probability(element);
  return sum;
}

}  // namespace

TEST_CASE("over many missions the policy by value knows more in the end than that by priority") {
  double by_priority = 0;
  double by_value = 0;
  int better = 0;
  constexpr int kMissions = 200;
  for (int seed = 0; seed < kMissions; ++seed) {
    const double one = flown(seed, next_by_priority);
    const double two = flown(seed, next_by_value);
    by_priority += one / kMissions;
    by_value += two / kMissions;
    better += two > one;
  }
  CHECK(by_value > 1.1 * by_priority);
  CHECK(better > 0.7 * kMissions);
}

}  // namespace element_policies_test
