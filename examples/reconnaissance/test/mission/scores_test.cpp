// How a mission that follows a target, or places emitters, is judged, and which orders are none.
#include "mission/scores.hpp"

#include <catch2/catch.hpp>

#include "mission/order_check.hpp"

namespace scores_test {

using namespace reconnaissance;
using Catch::Contains;

namespace {

const Local kTarget{5000, 2000, 100};

/// Seconds from 100 on; the report is that far off, and missing where `reported` says so.
template <class Reported, class InView>
std::vector<Check> judged(int seconds, double off_m, const Reported& reported,
                          const InView& in_view) {
  PursuitScore score({100, 0.9, 15});
  for (int i = 100; i < 100 + seconds; ++i) {
    // In any order.
    if (reported(i))
      score.report(i, Local{kTarget.north_m + off_m, kTarget.east_m, 0});
    else
      score.report(i, std::nullopt);
    score.truth(i, kTarget, in_view(i));
  }
  return score.checks();
}

bool always(int) { return true; }
bool never(int) { return false; }

std::vector<bool> passed(const std::vector<Check>& checks) {
  std::vector<bool> result;
  for (const Check& each : checks) result.push_back(each.passed);
  return result;
}

using Passed = std::vector<bool>;

const std::vector<Site> kSites{{"short-range site", {20000, 0, 0}},
                               {"mobile gun", {20000, 12000, 0}}};

}  // namespace

TEST_CASE("a target that was followed as long as ordered, in view and near the truth, passes") {
  const auto checks = judged(100, 9, always, always);
  CHECK(passed(checks) == Passed{true, true, true});
  CHECK_THAT(checks[0].text, Contains("found after 100 s"));
  CHECK_THAT(checks[2].text, Contains("9.0 m from where the target truly was"));
}

TEST_CASE("a target that was never found passes nothing") {
  CHECK(passed(judged(100, 0, never, always)) == Passed{false, false, false});
  CHECK(passed(PursuitScore({}).checks()) == Passed{false, false, false});
}

TEST_CASE(
    "what is reported after the ordered time does not count, also where that is no whole second") {
  PursuitScore score({99.5, 0.9, 15});
  for (int i = 0; i < 300; ++i) {
    score.report(i, Local{kTarget.north_m + (i < 100 ? 0.0 : 500.0), kTarget.east_m, 0});
    score.truth(i, kTarget, i < 100);
  }
  const auto checks = score.checks();
  CHECK(passed(checks) == Passed{true, true, true});
  CHECK_THAT(checks[1].text, Contains("for 100.0 %"));
}

TEST_CASE("half of the ordered time is half of it, however good") {
  const auto checks = judged(50, 0, always, always);
  CHECK(passed(checks) == Passed{true, false, true});
  CHECK_THAT(checks[1].text, Contains("50.0 % of 100 s"));
}

TEST_CASE("a memory of a target that is not in the image does not count as view") {
  const auto checks = judged(100, 0, always, [](int second) { return second >= 115; });
  CHECK(passed(checks) == Passed{true, false, true});
  CHECK_THAT(checks[1].text, Contains("85.0 %"));
  // What comes after the ordered time does not make up for it.
  CHECK_FALSE(judged(150, 0, always, [](int second) { return second >= 115; })[1].passed);
}

TEST_CASE("a track that is off is told by how much, and an interruption for how long") {
  const auto checks = judged(
      120, 20, [](int second) { return second < 130 || second >= 145; }, always);
  CHECK(passed(checks) == Passed{true, true, false});
  CHECK_THAT(checks[2].text, Contains("20.0 m from") && Contains("interrupted for 15 s"));
}

TEST_CASE("sites that are found, recognised and placed pass") {
  const auto checks = site_checks(
      kSites, {{"mobile gun", {20100, 12000, 0}}, {"short-range site", {20000, 250, 0}}}, 300);
  CHECK(passed(checks) == Passed{true, true, true});
  CHECK_THAT(checks[2].text, Contains("2 of 2 found, the worst 250 m"));
}

TEST_CASE("a site that is not reported fails, also in what is not known of it") {
  const auto checks = site_checks(kSites, {{"short-range site", {20000, 250, 0}}}, 300);
  CHECK(passed(checks) == Passed{false, false, false});
  CHECK_THAT(checks[0].text, Contains("1 of 2, not mobile gun"));
  CHECK(passed(site_checks(kSites, {}, 300)) == Passed{false, false, false});
}

TEST_CASE("a site that is taken for another kind, or is misplaced, fails in that alone") {
  const auto mistaken =
      site_checks(kSites, {{"coast radar", {20000, 0, 0}}, {"mobile gun", {20000, 12000, 0}}}, 300);
  CHECK(passed(mistaken) == Passed{true, false, true});
  CHECK_THAT(mistaken[1].text, Contains("short-range site for coast radar"));
  const auto misplaced = site_checks(
      kSites, {{"short-range site", {20400, 0, 0}}, {"mobile gun", {20000, 12000, 0}}}, 300);
  CHECK(passed(misplaced) == Passed{true, true, false});
  CHECK_THAT(misplaced[2].text, Contains("short-range site by 400 m"));
}

TEST_CASE("a site that is reported where there is none fails") {
  const auto checks = site_checks(kSites,
                                  {{"short-range site", {20000, 0, 0}},
                                   {"mobile gun", {20000, 12000, 0}},
                                   {"coast radar", {0, 0, 0}}},
                                  300);
  CHECK(passed(checks) == Passed{false, true, true});
  CHECK_THAT(checks[0].text, Contains("1 reported where there is none"));
}

TEST_CASE("a site that is reported twice is reported once where there is none") {
  const auto checks = site_checks(kSites,
                                  {{"short-range site", {20000, 0, 0}},
                                   {"short-range site", {20800, 0, 0}},
                                   {"mobile gun", {20000, 12000, 0}}},
                                  300);
  CHECK(passed(checks) == Passed{false, true, true});
}

TEST_CASE("a report is in time by when the site could first be heard") {
  ReportDelays delays;
  const auto at = [&](double now_s, bool first, bool second) {
    delays.truth(now_s, {{kSites[0], first}, {kSites[1], second}});
  };
  at(1, false, false);
  CHECK_FALSE(delays.check(1000).passed);
  at(100, true, false);
  // Far off, but it is the nearest one.
  delays.report(130, {{"coast radar", {20000, 4000, 0}}});
  CHECK_FALSE(delays.check(1000).passed);
  CHECK_THAT(delays.check(1000).text, Contains("1 of 2") && Contains("mobile gun never heard"));
  at(400, true, true);
  CHECK_THAT(delays.check(1000).text, Catch::EndsWith(": mobile gun never"));
  // Somewhere else there is another one.
  delays.report(410, {{"short-range site", {20000, 0, 0}}, {"mobile gun", {50000, 12000, 0}}});
  CHECK_FALSE(delays.check(1000).passed);
  delays.report(450, {{"short-range site", {20000, 0, 0}}, {"mobile gun", {20500, 12000, 0}}});
  delays.report(900, {{"short-range site", {20000, 0, 0}}, {"mobile gun", {20000, 12000, 0}}});
  CHECK(delays.check(60).passed);
  CHECK_THAT(delays.check(60).text, Contains("2 of 2 reported, at most 50 s"));
  CHECK_FALSE(delays.check(40).passed);
  CHECK_THAT(delays.check(40).text, Contains("mobile gun after 50 s"));
}

TEST_CASE("an order that contradicts itself says in what") {
  const Means means{980, 1800, 600, 2300};
  OrderText order{"convoy", true, false, 300, 0, 1200, 30, 0.3};
  CHECK_FALSE(contradiction_in(order, means));
  const auto with = [&](auto change) {
    OrderText other = order;
    change(other);
    return contradiction_in(other, means).value_or("");
  };
  CHECK_THAT(with([](OrderText& each) { each.follow_s = 0; }), Contains("for no time"));
  CHECK_THAT(with([](OrderText& each) { each.follow_s = 1300; }),
             Contains("followed for 1300 s, 600 s there and back") && Contains("1800"));
  CHECK_THAT(with([](OrderText& each) { each.stand_off_m = 500; }), Contains("radius of 980"));
  CHECK_THAT(with([](OrderText& each) { each.stand_off_m = 2500; }), Contains("2300 m at most"));

  order = {"north", false, true, 0, 400, 12000, 3000, 0};
  CHECK_FALSE(contradiction_in(order, means));
  CHECK_THAT(with([](OrderText& each) { each.within_m = 0; }), Contains("within no distance"));
  CHECK_THAT(with([](OrderText& each) { each.margin_m = 12000; }),
             Contains("12000 m from where it was reported"));
  // Images have no such order.
  CHECK_FALSE(contradiction_in({"depot"}, means));
}

}  // namespace scores_test
