#include "threats/air_defence_picture.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace air_defence_picture_test {

using namespace reconnaissance;
using skein::fusion::chi_square_quantile;
using skein::fusion::Estimate;
using skein::fusion::nees;

namespace {

constexpr int kRuns = 100;
const WarnerReceiver kReceiver;

double bound(double probability) { return chi_square_quantile(probability, 2 * kRuns) / kRuns; }

double flat(double, double) { return 0; }

struct Site {
  std::string type;
  Local antenna;
  Waveform waveform;
  double radiated_power_w;
};

const Site kShort{"short-range site", {6000, 8000, 10}, {3.0e9, 1e-3, 4}, 5e8};
const Site kMedium{"medium-range site", {9000, -12000, 10}, {3.2e9, 1.4e-3, 5}, 2e9};

/// Where an aircraft is that flies north at 60 m/s.
Local on_leg(double time_s) { return {60 * time_s, 0, 1000}; }

void hear(AirDefencePicture& picture, const Site& site, double time_s, Random& random,
          const Identification& identification) {
  const Emission emission{
      1, time_s, site.antenna, RadarMode::Search, site.waveform, site.radiated_power_w};
  const auto intercept = receive(emission, on_leg(time_s), kReceiver, flat, random);
  REQUIRE(intercept);
  picture.hear(*intercept, identification, on_leg(time_s));
}

Identification known(const Site& site) { return {site.type, RadarMode::Search, 0.9}; }

std::vector<double> truth(const Site& site) { return {site.antenna.north_m, site.antenna.east_m}; }

double power_w(const Local& aircraft) {
  return received_power_w(kShort.radiated_power_w, kShort.waveform.radio_frequency_hz,
                          slant_range_m(aircraft, kShort.antenna));
}

/// What another aircraft makes of its own bearings, from the far side.
Estimate from_elsewhere(const Site& site, Random& random) {
  std::vector<Bearing> bearings;
  for (int i = 0; i < 40; ++i) {
    const Local from{400.0 * i, 25000, 1000};
    const double bearing = course_between_rad(from, site.antenna);
    bearings.push_back({from, bearing + 0.035 * random.normal(), 0.035});
  }
  const auto found = triangulate(bearings);
  REQUIRE(found);
  return *found;
}

}  // namespace

TEST_CASE("Two sites heard in flight are two threats where they are, with their types") {
  AirDefencePicture picture(kReceiver);
  Random random(31);
  for (double time_s = 0; time_s < 120; time_s += 0.5) {
    hear(picture, kShort, time_s, random, known(kShort));
    hear(picture, kMedium, time_s, random, known(kMedium));
  }
  const auto threats = picture.threats();
  REQUIRE(threats.size() == 2);
  for (const Threat& threat : threats) {
    const Site& site = threat.emitter == kShort.type ? kShort : kMedium;
    CHECK(threat.emitter == site.type);
    CHECK((threat.heard && !threat.linked));
    CHECK(nees(threat.position, truth(site)) < chi_square_quantile(0.999, 2));
    CHECK(std::sqrt(threat.position.covariance[0]) < 300);
  }
}

TEST_CASE("How sites are placed is a choice: by squares they are where the filter has them") {
  AirDefencePicture picture(kReceiver);
  Random random(38);
  for (double time_s = 0; time_s < 180; time_s += 0.5) {
    hear(picture, kShort, time_s, random, known(kShort));
  }
  const auto filtered = picture.threats();
  const auto squared = picture.threats(by_triangulation);
  REQUIRE((filtered.size() == 1 && squared.size() == 1));
  // The filter knows a distance by the power, too.
  CHECK(std::hypot(filtered[0].position.mean[0] - squared[0].position.mean[0],
                   filtered[0].position.mean[1] - squared[0].position.mean[1]) < 20);
  CHECK(picture.threats([](auto, const Interval&) { return std::nullopt; }).empty());
}

TEST_CASE("However long a flight, its bearings stay few and say as much") {
  AirDefencePicture picture(kReceiver);
  Random random(39);
  std::vector<Bearing> all;
  for (double time_s = 0; time_s < 400; time_s += 0.1) {
    const double bearing =
        std::atan2(kShort.antenna.east_m, kShort.antenna.north_m - on_leg(time_s).north_m);
    // Better than they say, so that all fit.
    all.push_back({on_leg(time_s), bearing + 0.015 * random.normal(), 0.035});
    picture.hear({time_s, all.back().bearing_rad, 0.035, kShort.waveform, power_w(on_leg(time_s))},
                 known(kShort), on_leg(time_s));
  }
  std::size_t kept = 0;
  const auto threats = picture.threats([&](std::span<const Bearing> bearings, const Interval&) {
    kept = bearings.size();
    return triangulate(bearings);
  });
  CHECK(kept <= kGreatestBearings);
  CHECK(kept >= kGreatestBearings / 2);
  REQUIRE(threats.size() == 1);
  const auto exact = triangulate(all);
  REQUIRE(exact);
  for (const std::size_t i : {0, 3}) {
    CHECK(threats[0].position.covariance[i] == Approx(exact->covariance[i]).epsilon(0.001));
  }
  for (const std::size_t i : {0, 1}) {
    CHECK(threats[0].position.mean[i] == Approx(exact->mean[i]).margin(3));
  }
}

TEST_CASE("However long an aircraft circles, a site stays where it is") {
  AirDefencePicture picture(kReceiver);
  Random random(40);
  for (double time_s = 0; time_s < 1500; time_s += 0.05) {
    const double angle = 60 * time_s / 2500;
    const Local aircraft{2500 * std::sin(angle), 2500 * std::cos(angle), 1000};
    const double bearing = course_between_rad(aircraft, kShort.antenna);
    picture.hear(
        {time_s, bearing + 0.035 * random.normal(), 0.035, kShort.waveform, power_w(aircraft)},
        known(kShort), aircraft);
  }
  const auto threats = picture.threats();
  REQUIRE(threats.size() == 1);
  const auto& mean = threats[0].position.mean;
  CHECK(std::hypot(mean[0] - kShort.antenna.north_m, mean[1] - kShort.antenna.east_m) < 80);
}

TEST_CASE("By its power a site is placed sooner than by its bearings alone") {
  // Of a type that nobody knows the power of.
  Site unknown = kShort;
  unknown.type = "unknown type";
  const auto seconds_until_placed = [](const Site& site) {
    AirDefencePicture picture(kReceiver);
    Random random(32);
    double time_s = 0;
    while (picture.threats().empty() && time_s < 300) {
      hear(picture, site, time_s, random, known(site));
      time_s += 0.5;
    }
    return time_s;
  };
  // 8.5 s and 17.5 s.
  CHECK(seconds_until_placed(kShort) < 0.6 * seconds_until_placed(unknown));
}

TEST_CASE("Who stands still places a site by several powers, and is no surer than he may be") {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    AirDefencePicture picture(kReceiver);
    Random random(seed);
    for (double time_s = 0; time_s < 40; time_s += 4) {
      const Emission emission{
          1, time_s, kShort.antenna, RadarMode::Search, kShort.waveform, kShort.radiated_power_w};
      picture.hear(receive(emission, {}, kReceiver, flat, random).value(), known(kShort), {});
    }
    const auto threats = picture.threats();
    REQUIRE(threats.size() == 1);
    CHECK(greatest_deviation_m(threats[0].position) < 3000);
    sum += nees(threats[0].position, truth(kShort));
  }
  CHECK(sum / kRuns < bound(0.9999));
  CHECK(sum / kRuns > bound(0.0001));
}

TEST_CASE("Wrong identifications now and then make no threats") {
  AirDefencePicture picture(kReceiver);
  Random random(33);
  for (double time_s = 0; time_s < 300; time_s += 0.5) {
    const bool wrong = random.happens(0.05);
    hear(picture, kShort, time_s, random,
         wrong ? Identification{"mobile gun", RadarMode::Search, 0.6} : known(kShort));
    for (const Threat& threat : picture.threats()) CHECK(threat.emitter == kShort.type);
  }
  // Nor do emitters that no library has.
  hear(picture, kMedium, 301, random, {"", RadarMode::Off, 1});
  CHECK(picture.threats().size() == 1);
}

TEST_CASE("A link's track that agrees is fused with ours, another is a threat of its own") {
  AirDefencePicture picture(kReceiver);
  Random random(34);
  for (double time_s = 0; time_s < 120; time_s += 0.5) {
    hear(picture, kShort, time_s, random, known(kShort));
  }
  const Threat alone = picture.threats().at(0);
  const LinkTrack agreeing{5, kShort.type, from_elsewhere(kShort, random)};
  picture.report(agreeing);
  picture.report({6, kMedium.type, {truth(kMedium), {1e4, 0, 0, 1e4}}});
  picture.report({7, kShort.type, {{-20000, 8000}, {1e4, 0, 0, 1e4}}});
  const auto threats = picture.threats();
  REQUIRE(threats.size() == 3);
  const Estimate both[]{alone.position, agreeing.position};
  CHECK(threats[0].position == skein::fusion::intersect(both).fused);
  CHECK((threats[0].heard && threats[0].linked));
  CHECK(threats[1].id == AirDefencePicture::kFirstLinkNumber + 6);
  CHECK((!threats[1].heard && threats[1].linked));
  CHECK(threats[2].position.mean[0] == -20000);
  // The same report again says nothing new.
  picture.report(agreeing);
  CHECK(picture.threats()[0].position == threats[0].position);
}

TEST_CASE("A link's track is fused with one of ours at most") {
  AirDefencePicture picture(kReceiver);
  Random random(37);
  Site second = kShort;
  second.antenna.north_m += 6000;
  for (double time_s = 0; time_s < 60; time_s += 0.5) {
    hear(picture, kShort, time_s, random, known(kShort));
    hear(picture, second, time_s, random, known(second));
  }
  REQUIRE(picture.threats().size() == 2);
  picture.report({1, kShort.type, {{9000, 8000}, {9e6, 0, 0, 9e6}}});
  const auto threats = picture.threats();
  REQUIRE(threats.size() == 2);
  CHECK(threats[0].linked != threats[1].linked);
}

namespace {

/// The mean NEES of one site over all runs.
struct Consistency {
  double ours = 0;
  double link = 0;
  double picture = 0;  ///< Ours and the link's, by intersection.
  double added = 0;    ///< The same, as if they were independent.
};

/// What the link reports is what another aircraft knows itself, and what it has had from us after
/// so many seconds; the picture is that after 120 s.
Consistency fly_with_link(double sent_after_s, std::uint64_t seed) {
  Random random(seed);
  Consistency mean;
  const auto place = [](const AirDefencePicture& picture) {
    REQUIRE(picture.threats().size() == 1);
    return picture.threats()[0].position;
  };
  for (int run = 0; run < kRuns; ++run) {
    AirDefencePicture picture(kReceiver);
    Estimate sent;
    for (double time_s = 0; time_s < 120; time_s += 0.5) {
      hear(picture, kShort, time_s, random, known(kShort));
      if (time_s + 0.5 == sent_after_s) sent = place(picture);
    }
    const Estimate ours = place(picture);
    const Estimate independent[]{sent, from_elsewhere(kShort, random)};
    const Estimate link = skein::fusion::fuse_independent(independent);
    picture.report({1, kShort.type, link});
    const Estimate both[]{ours, link};
    mean.ours += nees(ours, truth(kShort)) / kRuns;
    mean.link += nees(link, truth(kShort)) / kRuns;
    mean.picture += nees(place(picture), truth(kShort)) / kRuns;
    mean.added += nees(skein::fusion::fuse_independent(both), truth(kShort)) / kRuns;
  }
  UNSCOPED_INFO("NEES of ours " << mean.ours << ", the link " << mean.link << ", the picture "
                                << mean.picture << ", added " << mean.added << "; bounds "
                                << bound(0.025) << " to " << bound(0.975));
  return mean;
}

}  // namespace

TEST_CASE(
    "After our report has come back over the link the picture is consistent; with tracks added as "
    "if they were independent it would be overconfident") {
  const Consistency at_once = fly_with_link(120, 35);
  for (const double consistent : {at_once.ours, at_once.link, at_once.picture}) {
    CHECK(consistent > bound(0.025));
    CHECK(consistent < bound(0.975));
  }
  CHECK(at_once.added > bound(0.975));
}

TEST_CASE("Nor is the picture overconfident if the link has an older report of ours") {
  const Consistency older = fly_with_link(90, 36);
  CHECK(older.picture < bound(0.975));
  CHECK(older.added > bound(0.975));
}

TEST_CASE(
    "Pictures differ in threats, their types, and places that moved by more than their error") {
  const Threat one{1,    "mobile gun", RadarMode::Search, 1, {{0, 0}, {250000, 0, 0, 10000}},
                   true, false};
  CHECK(greatest_deviation_m(one.position) == Approx(500));
  CHECK_FALSE(differ({one}, {one}));
  CHECK(differ({one}, {}));
  Threat other = one;
  other.position.mean = {0, 499};
  CHECK_FALSE(differ({one}, {other}));
  other.position.mean = {0, 501};
  CHECK(differ({one}, {other}));
  other = one;
  other.emitter = "coast radar";
  CHECK(differ({one}, {other}));
}

}  // namespace air_defence_picture_test
