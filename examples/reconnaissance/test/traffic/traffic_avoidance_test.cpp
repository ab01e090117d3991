#include <catch2/catch.hpp>
#include <numbers>
#include <vector>

#include "encounter_scene.hpp"

namespace traffic_avoidance_test {

using namespace reconnaissance;

namespace {

constexpr double kPi = std::numbers::pi;

struct Nobody {
  ResolutionAdvisory advise(const TrafficState&, std::span<const TrafficState>, double) {
    return {};
  }
};

}  // namespace

TEST_CASE("encounters that collide without avoidance keep well clear by the bands") {
  constexpr int kEncounters = 200;
  const Summary nobody = summary<Nobody>(kEncounters);
  const Summary bands = summary<BandsAvoider>(kEncounters);
  CHECK(nobody.collisions > 15);
  CHECK(nobody.violations == kEncounters);
  CHECK(bands.collisions == 0);
  CHECK(bands.violations == 0);
  CHECK(bands.recovered == kEncounters);
  CHECK(bands.back >= kEncounters - 5);
}

TEST_CASE("the potential field prevents the collisions, but not every loss of well clear") {
  constexpr int kEncounters = 200;
  const Summary field = summary<PotentialFieldAvoider>(kEncounters);
  CHECK(field.collisions == 0);
  CHECK(field.violations < 30);
  CHECK(field.recovered == kEncounters);
}

TEST_CASE("traffic that is seen with the errors of a radar is avoided, too") {
  constexpr int kEncounters = 100;
  const SurveillanceErrors errors{.place_m = 40, .height_m = 15, .speed_m_s = 2};
  const Summary bands = summary<BandsAvoider>(kEncounters, errors);
  CHECK(bands.collisions == 0);
  CHECK(bands.violations < 5);
  CHECK(bands.longest_violation_s < 30);
  CHECK(bands.recovered == kEncounters);
}

TEST_CASE("where well clear is already lost, recovery regains it without a near collision") {
  Random random(11);
  int given = 0;
  for (int i = 0; i < 100; ++i) {
    const Pair pair = colliding(random);
    // From 15 to 30 s before the closest approach, when the volume has been violated for some time.
    const auto violated = violation(pair.own, pair.other, kEnRoute, 400);
    if (!violated) continue;
    const double late_s = violated->in_s + 5 + 10 * random.uniform();
    const TrafficState own = straight_on(pair.own, late_s);
    const TrafficState other = straight_on(pair.other, late_s);
    if (!violates(own, other, kEnRoute)) continue;
    const std::vector others{other};
    const auto advisory = BandsAvoider().advise(own, others, own.course_rad(), AlertLevel::Warning);
    REQUIRE(advisory.is_given());
    CHECK(advisory.recovery);
    ++given;
    const Flown flown = fly<BandsAvoider>(own, other, 300, undisturbed);
    CAPTURE(i);
    CHECK(flown.nmac_multiple > 1);
    CHECK(flown.well_clear_at_end);
  }
  CHECK(given > 50);
}

TEST_CASE("a course into a weapon's reach is advised only if nothing else keeps well clear") {
  const TrafficState own = flying({0, 0, 1000}, 0, 60);
  const std::vector others{flying({14'000, 0, 1000}, kPi, 60)};
  const auto advised = [&](const BandsAvoider::MayFly& may_fly) {
    return BandsAvoider().advise(own, others, 0, AlertLevel::Warning, may_fly);
  };
  const auto right = advised([](double) { return true; });
  CHECK(right.course_rad.value() > 0);
  const auto left = advised([](double course_rad) { return course_rad < 0; });
  CHECK(left.course_rad.value() < 0);
  const auto nowhere = advised([](double) { return false; });
  CHECK((nowhere.climb_m_s && !nowhere.course_rad && !nowhere.recovery));
}

TEST_CASE("head-on, both aircraft turn right, and pass well clear") {
  const TrafficState own = flying({0, 0, 1000}, 0, 60);
  const TrafficState other = flying({14'000, 0, 1000}, kPi, 60);
  const std::vector seen_by_own{straight_on(other, 70)};
  const auto advisory =
      BandsAvoider().advise(straight_on(own, 70), seen_by_own, 0, AlertLevel::Corrective);
  REQUIRE(advisory.course_rad);
  CHECK(*advisory.course_rad > 0);
  CHECK(*advisory.course_rad < kPi / 2);

  Equipment<BandsAvoider> of_other;
  int step = 0;
  ResolutionAdvisory others_advisory;
  const Flown flown = fly<BandsAvoider>(
      own, other, 300, [&](const TrafficState& state, const TrafficState& intruder) {
        if (step++ % 10 == 0) others_advisory = of_other.advise(state, intruder, kPi);
        return steered(state, others_advisory, kPi);
      });
  CHECK(flown.violated_s == 0);
  CHECK(flown.on_course_at_end);
}

TEST_CASE("two aircraft that both avoid by the bands do not collide") {
  Random random(13);
  int violations = 0;
  for (int i = 0; i < 100; ++i) {
    const Pair pair = colliding(random);
    if (violates(pair.own, pair.other, kEnRoute)) continue;
    Equipment<BandsAvoider> of_other;
    int step = 0;
    ResolutionAdvisory advisory;
    const double route_rad = pair.other.course_rad();
    const Flown flown = fly<BandsAvoider>(
        pair.own, pair.other, 400, [&](const TrafficState& state, const TrafficState& intruder) {
          if (step++ % 10 == 0) advisory = of_other.advise(state, intruder, route_rad);
          return steered(state, advisory, route_rad);
        });
    CAPTURE(i);
    CHECK(flown.nmac_multiple > 1);
    CHECK(flown.well_clear_at_end);
    violations += flown.violated_s > 0;
  }
  CHECK(violations <= 5);
}

TEST_CASE("what is seen in a mirror is avoided in a mirror") {
  Random random(12);
  for (int i = 0; i < 50; ++i) {
    const double course = kPi / 6 + 2 * kPi / 3 * random.uniform();
    const TrafficState own = flying({0, 0, 1000}, 0, 60);
    TrafficState there = straight_on(own, 40);
    there.place.north_m += 500;
    const TrafficState left = straight_on(flying(there.place, course, 70), -40);
    const TrafficState right = straight_on(flying(there.place, -course, 70), -40);
    const std::vector lefts{left};
    const std::vector rights{right};
    const auto one = BandsAvoider().advise(own, lefts, 0, AlertLevel::Corrective);
    const auto two = BandsAvoider().advise(own, rights, 0, AlertLevel::Corrective);
    REQUIRE(one.course_rad);
    REQUIRE(two.course_rad);
    CHECK(*one.course_rad == Approx(-*two.course_rad));
  }
}

TEST_CASE("between two intruders neither is violated to avoid the other") {
  const TrafficState own = flying({0, 0, 1000}, 0, 60);
  const std::vector ahead{flying({7000, 0, 1000}, kPi, 60)};
  const auto alone = BandsAvoider().advise(own, ahead, 0, AlertLevel::Corrective);
  REQUIRE(alone.course_rad);
  CHECK(*alone.course_rad > 0);
  // The second flies along on the right.
  const std::vector both{ahead[0], flying({0, 1400, 1000}, 0, 60)};
  const auto advisory = BandsAvoider().advise(own, both, 0, AlertLevel::Corrective);
  REQUIRE(advisory.course_rad);
  CHECK(*advisory.course_rad < 0);
  for (const Manoeuvre& one : course_bands(own, both, kEnRoute, {})) {
    if (one.value == *advisory.course_rad) CHECK(one.free);
  }
}

TEST_CASE("who meets nobody is advised nothing") {
  const TrafficState own = flying({0, 0, 1000}, 0, 60);
  const std::vector beside{flying({0, 3000, 1000}, 0, 60)};
  CHECK(!BandsAvoider().advise(own, beside, 0, AlertLevel::None).is_given());
  CHECK(!PotentialFieldAvoider().advise(own, beside, 0).is_given());
  CHECK(!BandsAvoider().advise(own, {}, 0, AlertLevel::None).is_given());
}

TEST_CASE("the bands avoid from a corrective alert on, not before, and until the route is free") {
  const TrafficState own = flying({0, 0, 1000}, 0, 60);
  const std::vector ahead{flying({7000, 0, 1000}, kPi, 60)};
  BandsAvoider avoider;
  CHECK(!avoider.advise(own, ahead, 0, AlertLevel::None).is_given());
  CHECK(!avoider.advise(own, ahead, 0, AlertLevel::Preventive).is_given());
  CHECK(avoider.advise(own, ahead, 0, AlertLevel::Corrective).is_given());
  CHECK(avoider.advise(own, ahead, 0, AlertLevel::None).is_given());
  const std::vector past{flying({-3000, 0, 1000}, kPi, 60)};
  CHECK(!avoider.advise(own, past, 0, AlertLevel::None).is_given());
}

}  // namespace traffic_avoidance_test
