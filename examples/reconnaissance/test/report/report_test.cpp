#include "report/report.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "report_scene.hpp"

namespace report_test {

using namespace reconnaissance;
using Catch::Contains;
using Catch::StartsWith;

namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// What stands in the page for its script.
std::string record_in(const std::string& page) {
  const std::string begin = "<script id=\"record\" type=\"application/json\">";
  const auto from = page.find(begin) + begin.size();
  return page.substr(from, page.find("</script>", from) - from);
}

MissionRecord small_mission() {
  MissionRecord record;
  record.mission = "reconnaissance";
  record.verdict = {true, true, "", 1240.4, 74380, {{"fuel", true, "64 kg left"}}};
  record.targets = {{"depot", {{1, 2, 3}}, 3, 0.3, 0.19, 4, 354.0, {}},
                    {"road", {{5, 6, 7}}, 1, 0.3, 0, 0, {}, {}}};
  record.tracked_s = 41;
  record.survival = 0.991;
  return record;
}

}  // namespace

TEST_CASE("the first line tells verdict, duration, distance, targets, exposure and misses") {
  MissionRecord record = small_mission();
  CHECK(
      headline(record) ==
      "Passed · 20 min 40 s · 74.4 km · 1 of 2 targets · tracked 41 s, survival 0.991 · 0 misses");
  record.verdict.passed = false;
  record.decisions.resize(2);
  record.decisions[1].late = true;
  CHECK_THAT(headline(record), StartsWith("Failed · "));
  CHECK_THAT(headline(record), Contains("· 1 miss") && !Contains("misses"));
  record.lost_samples = 2;
  record.verdict.flown = false;
  CHECK_THAT(headline(record), StartsWith("Not flown to its end · ") && Contains("3 misses"));
}

TEST_CASE("what was unusual is told in the order of time") {
  MissionRecord record = small_mission();
  CHECK(flags_of(record).empty());
  record.track = {{0}, {900}};
  record.verdict.checks.push_back({"survival", false, "0.93, at least 0.95"});
  record.faults = {{100, 140.0, "Set 2 is wrong", "flight_controller", 101.5, "left out"},
                   {300, {}, "The camera is silent", "nhp", 302, "none"}};
  record.decisions = {{200, "navigator", "a route", "", "nobody had one", {}, 0.1, false},
                      {201, "navigator", "a route", "", "nobody had one", {}, 0.1, false},
                      {150, "navigator", "a route", "AStar", "the other was late", {}, 0.1, true},
                      {160, "navigator", "a route", "AStar", "as usual", {}, 0.1, false}};
  record.flags = {{50, false, "a site popped up"}};
  const auto flags = flags_of(record);
  REQUIRE(flags.size() == 6);
  CHECK(std::ranges::is_sorted(flags, {}, &Flag::time_s));
  CHECK(flags[0].text == "a site popped up");
  CHECK(flags[1].text == "Set 2 is wrong: noticed by flight_controller after 1.5 s");
  CHECK_FALSE(flags[1].severe);
  CHECK_THAT(flags[2].text, Contains("without an answer in time"));
  CHECK(flags[3].text == "navigator found no answer: a route, 2 times");
  CHECK_THAT(flags[4].text, Contains("not healed"));
  CHECK(flags[4].severe);
  CHECK(flags[5].time_s == 900);
  CHECK(flags[5].text == "survival: 0.93, at least 0.95");
}

TEST_CASE(
    "of many latencies the twin has as many as a histogram can show, and how many there were") {
  MissionRecord record = small_mission();
  Latencies many{"navigator: AStar", {}};
  for (int i = 10'000; i > 0; --i) many.seconds.push_back(i * 1e-3);
  record.latencies = {many, {"navigator: RRTConnect", {0.5}}, {"navigator: none", {}}};
  const auto latencies = nlohmann::json::parse(to_json(record))["latencies"];
  CHECK(latencies[0]["count"] == 10'000);
  const auto seconds = latencies[0]["seconds"].get<std::vector<double>>();
  CHECK(seconds.size() == 400);
  CHECK(std::ranges::is_sorted(seconds));
  CHECK(seconds.front() == 0.001);
  CHECK(seconds.back() == 10);
  CHECK(seconds[200] == Approx(5).margin(0.05));
  CHECK(latencies[1]["seconds"] == nlohmann::json{0.5});
  CHECK(latencies[2]["seconds"].empty());
}

TEST_CASE("the twin has what was recorded, in metres, seconds and degrees") {
  MissionRecord record = small_mission();
  TrackPoint point;
  point.time_s = 12;
  point.place = {100.04, -200, 480};
  point.height_above_ground_m = 300;
  point.heading_rad = point.bank_rad = std::numbers::pi / 6;
  record.track = {point};
  record.routes = {{20, "AStar", {{1, 2, 3}, {4, 5, 6}}}};
  const auto json = nlohmann::json::parse(to_json(record));
  CHECK(json["verdict"] == "passed");
  CHECK(json["headline"] == headline(record));
  CHECK(json["distance_m"] == 74380);
  CHECK(json["targets"][0]["collected_s"] == 354);
  CHECK(json["targets"][1]["collected_s"].is_null());
  CHECK(json["track"]["north_m"] == nlohmann::json{100.0});
  CHECK(json["track"]["bank_deg"] == nlohmann::json{30.0});
  CHECK(json["routes"][0]["points"][1] == nlohmann::json{4.0, 5.0, 6.0});
}

TEST_CASE("what is no number is null in the twin, and what is not UTF-8 is replaced") {
  MissionRecord record = small_mission();
  record.survival = std::numeric_limits<double>::quiet_NaN();
  record.targets[0].name = "a\xff";
  const auto json = nlohmann::json::parse(to_json(record));
  CHECK(json["survival"].is_null());
  CHECK(json["targets"][0]["name"] == "a\uFFFD");
  CHECK_NOTHROW(to_html(record));
}

TEST_CASE("no text of the record ends the page's script or becomes markup") {
  MissionRecord record = small_mission();
  const std::string text = "</script><!--<script>alert(1)</script><b>&\"'";
  record.mission = record.command = record.targets[0].name = text;
  record.verdict.checks[0].text = text;
  const std::string page = to_html(record);
  CHECK(count_of(page, "<script") == 2);
  CHECK(count_of(page, "</script") == 2);
  CHECK(count_of(page, "<b>") == 0);
  CHECK(nlohmann::json::parse(record_in(page)) == nlohmann::json::parse(to_json(record)));
}

TEST_CASE("the page refers to nothing outside of itself") {
  const std::string page = to_html(test::flown_mission());
  CHECK(count_of(page, "https:") == 0);
  CHECK(count_of(page, "http:") == count_of(page, "\"http://www.w3.org/2000/svg\""));
  CHECK(count_of(page, "url(") == count_of(page, "url(#"));
  CHECK(count_of(page, "<link") + count_of(page, "@import") + count_of(page, "src=") == 0);
}

TEST_CASE("the ground of a report lies around all that it shows") {
  const MissionRecord record = test::flown_mission();
  const GroundGrid& ground = record.ground;
  REQUIRE(ground.columns == 180);
  REQUIRE(ground.heights_m.size() % ground.columns == 0);
  const double rows = static_cast<double>(ground.heights_m.size() / ground.columns - 1);
  const auto has = [&](const Local& place) {
    return place.north_m > ground.south_m && place.east_m > ground.west_m &&
           place.north_m < ground.south_m + rows * ground.spacing_m &&
           place.east_m < ground.west_m + 179 * ground.spacing_m;
  };
  CHECK(std::ranges::all_of(record.track, [&](const TrackPoint& p) { return has(p.place); }));
  CHECK(std::ranges::all_of(record.threats, [&](const KnownThreat& t) { return has(t.place); }));
  // Rows go from south to north, columns from west to east.
  const Hills hills(180, 7);
  CHECK(ground.heights_m[3 * 180 + 5] ==
        hills(ground.south_m + 3 * ground.spacing_m, ground.west_m + 5 * ground.spacing_m));
  CHECK(ground_around({}, 100, hills).heights_m.empty());
}

}  // namespace report_test
