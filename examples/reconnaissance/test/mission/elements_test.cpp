#include "mission/elements.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "skein/error.hpp"

namespace elements_test {

using namespace reconnaissance;

TEST_CASE("elements and objects are what a profile names") {
  const auto elements =
      parse_elements("depot 3 5 0.3 30 53.4 27.6; road 2 3 0.25 40 53.40 27.71 53.38 27.73;");
  REQUIRE(elements.size() == 2);
  CHECK(elements[0].name == "depot");
  CHECK(elements[0].margin_m == 30);
  CHECK(elements[1].wanted_sample_m == 0.25);
  REQUIRE(elements[1].line.size() == 2);
  CHECK(elements[1].line[1].longitude_deg == 27.73);
  CHECK_THROWS_AS(parse_elements("depot 3 5 0.3 53.4 27.6"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_elements("depot 3 5 0.3 30 53.4"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_elements("depot 3 5 0.3 30 north 27.6"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_elements("depot 0 5 0.3 30 53.4 27.6"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_elements("depot 3 5 0.3 30 95 27.6"), skein::InvalidArgument);

  const auto objects = parse_objects("53.4 27.6 3 90 2.5");
  REQUIRE(objects.size() == 1);
  CHECK(objects[0].legs[0].course_rad == Approx(std::numbers::pi / 2));
  CHECK(objects[0].legs[0].speed_m_s == 2.5);
  CHECK_THROWS_AS(parse_objects("53.4 27.6 3 90"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_objects("53.4 27.6 3 90 2.5 100 0"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_objects("53.4 27.6 3 90 2.5 100 0 5 100 0 6"), skein::InvalidArgument);
}

TEST_CASE("what no element or object can be is refused, and told by its own text") {
  for (const std::string wrong :
       {"depot -3 5 0.3 30 53.4 27.6", "depot 3 5 0.3 -30 53.4 27.6", "depot 3 5 nan 30 53.4 27.6",
        "depot inf 5 0.3 30 53.4 27.6", "depot 3 1e300 0.3 30 53.4 27.6",
        "depot 3 5 0.3 30 53.4 27.6 1e999", "depot 3 5 0.3 30 53.4 27,6", "depot"}) {
    CAPTURE(wrong);
    CHECK_THROWS_WITH(parse_elements("road 2 3 0.3 30 53.4 27.7; " + wrong),
                      Catch::StartsWith("'" + wrong + "' is no element; write `name priority"));
  }
  CHECK_THROWS_WITH(parse_elements("depot 3 5 0.3 30 53.4 27.6; depot 1 5 0.3 30 53.5 27.6"),
                    "two elements are called 'depot'");
  for (const std::string wrong : {"95 27.6 3 0 0", "53.4 270 3 0 0", "53.4 27.6 3 nan 0",
                                  "53.4 27.6 3 0 0 10 0 1e999", "53.4 27.6 -3 0 0"}) {
    CAPTURE(wrong);
    CHECK_THROWS_WITH(parse_objects(wrong), Catch::StartsWith("'" + wrong + "' is no object"));
  }
}

TEST_CASE("each line of a list is a part of it, as is what stands between semicolons") {
  const auto elements = parse_elements(
      "depot 3 5 0.3 30 53.4 27.6\r\n\n  road 2 3 0.25 40 53.40 27.71 53.38 27.73;\n"
      "bridge 2 4 0.3 20 53.34 27.64; dam 2 5 0.3 30 53.33 27.52\n");
  REQUIRE(elements.size() == 4);
  CHECK(elements[1].name == "road");
  CHECK(elements[3].name == "dam");
}

TEST_CASE("an object drives, stops and turns when the profile says so") {
  const auto legs = parse_objects("53.4 27.6 3 90 2.5 100 90 0 160 0 5")[0].legs;
  const auto at = [&](double now_s) { return moved({10, 20, 0}, legs, now_s); };
  CHECK(at(0).east_m == 20);
  CHECK(at(40).east_m == Approx(120));
  CHECK(at(130).east_m == Approx(270));
  CHECK(at(130).north_m == Approx(10));
  CHECK(at(180).east_m == Approx(270));
  CHECK(at(180).north_m == Approx(110));
}

TEST_CASE("a place is passed where it is abeam, to the right or to the left") {
  const Passage east = passage({100, 200, 0}, std::numbers::pi / 2, {50, 1200, 0});
  CHECK(east.ahead_m == Approx(1000));
  CHECK(east.offset_m == Approx(50));
  const Passage south = passage({0, 0, 0}, std::numbers::pi, {500, 30, 0});
  CHECK(south.ahead_m == Approx(-500));
  CHECK(south.offset_m == Approx(-30));
}

TEST_CASE("an element is ahead until it is abeam, however far aside a camera sees it") {
  CHECK(is_ahead({20'000, 700}));
  CHECK(is_ahead({1, 700}));
  CHECK(is_ahead({1, -2400}));
  CHECK_FALSE(is_ahead({-1, 700}));
  CHECK_FALSE(is_ahead({5000, 2600}));
  CHECK_FALSE(is_ahead({5000, -2600}));
}

TEST_CASE("a road goes straight on beyond both of its ends, and a single place does not") {
  const auto road = prolonged({{0, 0, 0}, {300, 0, 0}, {300, 400, 0}}, 100);
  REQUIRE(road.size() == 3);
  CHECK(road[0].north_m == Approx(-100));
  CHECK(road[1].east_m == 0);
  CHECK(road[2].north_m == Approx(300));
  CHECK(road[2].east_m == Approx(500));
  CHECK(prolonged({{5, 6, 0}}, 100).front().north_m == 5);
}

TEST_CASE("the middle of a line is half of its length from either end, its parts are all of it") {
  const std::vector<Local> bend{{0, 0, 10}, {300, 0, 10}, {300, 900, 70}};
  const Local middle = middle_of(bend);
  CHECK(middle.north_m == Approx(300));
  CHECK(middle.east_m == Approx(300));
  CHECK(middle.height_m == Approx(30));
  CHECK(middle_of({{7, 8, 9}}).east_m == 8);

  const auto parts = parts_of_line(bend, 100);
  REQUIRE(parts.size() == 13);
  CHECK(parts[3].north_m == Approx(300));
  CHECK(parts[4].east_m == Approx(100));
  CHECK(parts.back().east_m == Approx(900));
  CHECK(parts_of_line({{7, 8, 9}}, 50).size() == 1);
}

}  // namespace elements_test
