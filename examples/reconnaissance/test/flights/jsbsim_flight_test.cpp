// JSBSim flies: as the point mass does where that knows enough, and goes on when it dies.
#include <signal.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "flight/angles.hpp"
#include "flight/guidance.hpp"
#include "flight/pilot.hpp"
#include "jsbsim/failure.hpp"
#include "jsbsim/flight.hpp"
#include "jsbsim_program.hpp"

using namespace reconnaissance;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

constexpr double kTick_s = JsbsimFlight::kTick_s;
constexpr double kGround_m = 180;

Aircraft cruising() {
  Aircraft aircraft;
  aircraft.position.height_m = 930;
  aircraft.airspeed_m_s = aircraft.north_m_s = 35;
  aircraft.fuel_kg = 4;
  aircraft.on_ground = false;
  return aircraft;
}

/// JSBSim, and beside it the point mass with the figures of the same aircraft.
struct Both {
  explicit Both(const Aircraft& from = cruising(), JsbsimFlight::Options options = {})
      : jsbsim(with_program(std::move(options))), rigid(from), point(from) {
    jsbsim.place(from);
  }

  static JsbsimFlight::Options with_program(JsbsimFlight::Options options) {
    options.program = skein::test::jsbsim_program();
    options.origin = {53.3, 27.4, kGround_m};
    return options;
  }

  void fly(const Demand& demand, double seconds, const Wind& wind = {}) {
    for (int i = 0; i < std::lround(seconds / kTick_s); ++i) {
      rigid = jsbsim.advance(demand, wind, kGround_m);
      point = advance(type.airframe, point, demand, wind, kGround_m, kTick_s);
      REQUIRE_FALSE(rigid.stalled);
    }
  }

  const AircraftType& type = aircraft_type("tactical");
  JsbsimFlight jsbsim;
  Aircraft rigid;
  Aircraft point;
};

double far(const Local& a, const Local& b) {
  return std::hypot(a.north_m - b.north_m, a.east_m - b.east_m, a.height_m - b.height_m);
}

}  // namespace

TEST_CASE("JSBSim flies on from where it is placed, level and trimmed") {
  Both both;
  both.fly({0, 0, 35}, 20);
  CHECK(both.rigid.airspeed_m_s == Approx(35).margin(1.5));
  CHECK(both.rigid.bank_rad == Approx(0).margin(radians(1)));
  CHECK(both.rigid.climb_rad == Approx(0).margin(radians(0.5)));
  CHECK(both.rigid.position.height_m == Approx(930).margin(5));
  CHECK(both.rigid.position.north_m == Approx(both.point.position.north_m).margin(20));
  CHECK(both.rigid.position.east_m == Approx(0).margin(20));
}

TEST_CASE("JSBSim turns as the point mass does, to either side") {
  const double bank = radians(GENERATE(20, -20));
  Both both;
  both.fly({bank, 0, 35}, 30);
  CHECK(both.rigid.bank_rad == Approx(bank).margin(radians(1.5)));
  const double turned = wrapped(both.rigid.heading_rad),
               as_wanted = wrapped(both.point.heading_rad);
  CHECK(wrapped(turned - as_wanted) == Approx(0).margin(radians(12)));
  CHECK(both.rigid.position.height_m == Approx(930).margin(10));
  CHECK(both.rigid.airspeed_m_s == Approx(35).margin(1));
}

TEST_CASE("JSBSim climbs and descends as the point mass does") {
  const double climb = radians(GENERATE(4, -4));
  Both both;
  both.fly({0, climb, 35}, 60);
  const double risen = both.rigid.position.height_m - 930;
  CHECK(risen == Approx(both.point.position.height_m - 930).epsilon(0.06));
  CHECK(both.rigid.climb_rad == Approx(climb).margin(radians(0.5)));
  CHECK(both.rigid.airspeed_m_s == Approx(35).margin(1.5));
}

TEST_CASE("JSBSim becomes slower and faster as is demanded, at its height") {
  Both both;
  both.fly({0, 0, 25}, 60);
  CHECK(both.rigid.airspeed_m_s == Approx(25).margin(1));
  both.fly({0, 0, 35}, 60);
  CHECK(both.rigid.airspeed_m_s == Approx(35).margin(1));
  CHECK(both.rigid.position.height_m == Approx(930).margin(15));
}

TEST_CASE("JSBSim is carried by the wind, and flies as fast through the air") {
  const Wind wind{-4, 6, 0};
  Aircraft from = cruising();
  from.north_m_s += wind.north_m_s;
  from.east_m_s += wind.east_m_s;
  Both both(from);
  both.fly({0, 0, 35}, 30, wind);
  CHECK(both.rigid.airspeed_m_s == Approx(35).margin(1.5));
  CHECK(both.rigid.position.east_m == Approx(both.point.position.east_m).margin(25));
  CHECK(both.rigid.position.north_m == Approx(both.point.position.north_m).margin(25));
}

TEST_CASE("JSBSim burns fuel as the planners expect, or less") {
  Both both;
  both.fly({0, 0, 35}, 60);
  const double burnt_kg_s = (4 - both.rigid.fuel_kg) / 60;
  CHECK(burnt_kg_s <= both.type.fuel_kg_s);
  CHECK(burnt_kg_s > both.type.fuel_kg_s / 2);
}

TEST_CASE("where JSBSim is agrees with how it moves") {
  Both both;
  Local summed = both.rigid.position;
  both.fly({0, 0, 35}, kTick_s);
  summed = both.rigid.position;
  for (int i = 0; i < 3000; ++i) {
    const Aircraft before = both.rigid;
    both.fly({0.3, 0.02, 35}, kTick_s);
    summed.north_m += (before.north_m_s + both.rigid.north_m_s) / 2 * kTick_s;
    summed.east_m += (before.east_m_s + both.rigid.east_m_s) / 2 * kTick_s;
    summed.height_m += (before.up_m_s + both.rigid.up_m_s) / 2 * kTick_s;
  }
  CHECK(far(summed, both.rigid.position) < 3);
}

TEST_CASE("the same demands lead to the same flight, bit by bit") {
  const auto flown = [] {
    Both both;
    both.fly({0.3, 0.05, 33}, 10, {3, -2, 0.5});
    return both.rigid;
  };
  const Aircraft one = flown(), other = flown();
  CHECK(one.position.north_m == other.position.north_m);
  CHECK(one.position.east_m == other.position.east_m);
  CHECK(one.position.height_m == other.position.height_m);
  CHECK(one.airspeed_m_s == other.airspeed_m_s);
  CHECK(one.fuel_kg == other.fuel_kg);
}

TEST_CASE("JSBSim takes off, flies legs, and lands on the runway, in wind from each side") {
  // 3 m/s across the runway: about as much as its nose wheel holds against.
  const double wind_from = radians(GENERATE(110, 50));
  const Wind wind{-6 * std::cos(wind_from), -6 * std::sin(wind_from), 0};
  const Strip strip{{0, 0, kGround_m}, radians(80), 1500};
  Aircraft parked;
  parked.position.height_m = kGround_m;
  parked.heading_rad = strip.course_rad;
  parked.fuel_kg = 4;
  Both both(parked);
  Pilot pilot(
      both.type.rules,
      {[](const Motion& motion, const Line& line) { return l1_bank_rad({}, motion, line); },
       [](const Motion& motion, const Circle& circle) { return l1_bank_rad({}, motion, circle); }});
  const auto fly_until = [&](const auto& until, double longest_s) {
    for (double time_s = 0; time_s < longest_s; time_s += kTick_s) {
      const Aircraft& now = both.rigid;
      const Measurement seen{now.position,     now.north_m_s,   now.east_m_s,  now.up_m_s,
                             now.airspeed_m_s, now.heading_rad, now.climb_rad, now.bank_rad};
      const Demand demand = pilot.fly({seen, now.position.height_m - kGround_m, now.on_ground});
      both.rigid = both.jsbsim.advance(demand, wind, kGround_m);
      REQUIRE_FALSE(both.rigid.stalled);
      if (until()) return true;
    }
    return false;
  };
  fly_until([] { return false; }, 2);
  CHECK(far(both.rigid.position, strip.threshold) < 0.5);  // the brakes hold it

  REQUIRE(pilot.take_off(strip).empty());
  REQUIRE(fly_until([&] { return !both.rigid.on_ground; }, 60));
  const auto beside_m = [&] {
    const Local& at = both.rigid.position;
    return at.east_m * std::cos(strip.course_rad) - at.north_m * std::sin(strip.course_rad);
  };
  CHECK(std::abs(beside_m()) < 15);
  REQUIRE(fly_until([&] { return both.rigid.position.height_m > kGround_m + 100; }, 200));

  const Local here = both.rigid.position;
  REQUIRE(pilot.follow({here, {1500, 1500, 400}, {1500, 0, 400}}).empty());
  double nearest_m = 1e9;
  REQUIRE(fly_until(
      [&] {
        const Local& at = both.rigid.position;
        nearest_m = std::min(nearest_m, std::hypot(at.north_m - 1500, at.east_m));
        return pilot.mode() == Pilot::Mode::Waiting;
      },
      400));
  CHECK(nearest_m < 60);

  const double slope = std::tan(radians(4));
  REQUIRE(pilot
              .land({both.rigid.position, on_centre_line(strip, -3500, 2150 * slope),
                     on_centre_line(strip, -2000, 2150 * slope), on_centre_line(strip, 150, 0)},
                    strip)
              .empty());
  REQUIRE(fly_until([&] { return both.rigid.on_ground; }, 600));
  const Local down = both.rigid.position;
  const double beyond_m =
      down.north_m * std::cos(strip.course_rad) + down.east_m * std::sin(strip.course_rad);
  CHECK(beyond_m == Approx(150).margin(150));
  CHECK(std::abs(beside_m()) < 15);
  REQUIRE(fly_until([&] { return pilot.mode() == Pilot::Mode::Landed; }, 60));
  CHECK(std::abs(beside_m()) < 20);
}

TEST_CASE("a JSBSim that is killed in flight is replaced within two seconds, and nothing jumps") {
  std::string told;
  Both both(cruising(), {.tell = [&](const std::string& what) { told = what; }});
  const Demand turn{radians(20), 0, 35};
  both.fly(turn, 15);
  const Aircraft before = both.rigid;
  const pid_t first = both.jsbsim.pid();
  kill(first, SIGKILL);
  const auto began = std::chrono::steady_clock::now();
  both.fly(turn, 5 * kTick_s);
  CHECK(std::chrono::steady_clock::now() - began < 2s);
  CHECK(both.jsbsim.pid() != first);
  CHECK(both.jsbsim.replaced() == 1);
  CHECK_THAT(told, Contains("it has died of Killed") && Contains("flies on from the last state"));
  // 0.1 s, and the steps in which it is started.
  CHECK(far(before.position, both.rigid.position) < 10);
  CHECK(both.rigid.airspeed_m_s == Approx(before.airspeed_m_s).margin(1.5));
  CHECK(both.rigid.bank_rad == Approx(before.bank_rad).margin(radians(6)));
  CHECK(both.rigid.fuel_kg == Approx(before.fuel_kg).margin(1e-3));
  both.fly(turn, 10);
  CHECK(both.rigid.position.height_m == Approx(before.position.height_m).margin(8));
}

TEST_CASE("a JSBSim that hangs is replaced when it has been silent for the patience") {
  Both both(cruising(), {.patience = 500ms});
  both.fly({0, 0, 35}, 2);
  kill(both.jsbsim.pid(), SIGSTOP);
  both.fly({0, 0, 35}, 2);
  CHECK(both.jsbsim.replaced() == 1);
  CHECK(both.rigid.airspeed_m_s == Approx(35).margin(2));
}

TEST_CASE("a JSBSim that cannot be replaced is told, after some tries") {
  Both both;
  both.fly({0, 0, 35}, 1);
  setenv("TMPDIR", "/nowhere", 1);
  kill(both.jsbsim.pid(), SIGKILL);
  CHECK_THROWS_WITH(both.jsbsim.advance({0, 0, 35}, {}, kGround_m),
                    Contains("JSBSim has failed 3 times in a row") && Contains("no folder"));
  CHECK(both.jsbsim.pid() == -1);
  unsetenv("TMPDIR");
  both.fly({0, 0, 35}, 1);
  CHECK(both.rigid.airspeed_m_s == Approx(35).margin(2));
}

TEST_CASE("JSBSim flies five times as fast as time passes, or faster") {
  Both both;
  const auto began = std::chrono::steady_clock::now();
  both.fly({0, 0, 35}, 20);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  WARN("20 s of flight took " << took.count() << " s");
  CHECK(took < 4s);
}
