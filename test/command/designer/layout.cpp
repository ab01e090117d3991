// Where the boxes of `skein designer` stand.
#include "command/designer/layout.hpp"

#include <catch2/catch.hpp>

#include "skein/error.hpp"

using namespace skein::command::designer;

namespace {

std::vector<EntityState> entities(const std::vector<std::string>& names) {
  std::vector<EntityState> made;
  for (const std::string& name : names) {
    EntityState entity;
    entity.name = name;
    entity.system = "uav-1";
    entity.services.resize(2);
    made.push_back(entity);
  }
  return made;
}

Link calls(const std::string& from, const std::string& to) {
  Link link;
  link.source = from;
  link.target = to;
  link.kind = LinkKind::Calls;
  link.name = "I";
  return link;
}

/// One beside the other.
std::vector<Place> in_a_row(const Drawing& drawing) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < drawing.boxes.size(); ++i)
    places.push_back({300.0 * static_cast<double>(i), 0});
  return places;
}

bool overlap(const EntityState& one, const EntityState& other) {
  return one.x < other.x + other.width && other.x < one.x + one.width &&
         one.y < other.y + other.height && other.y < one.y + one.height;
}

void check_no_overlap(const std::vector<EntityState>& entities) {
  for (std::size_t i = 0; i < entities.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      CAPTURE(entities[i].name, entities[k].name);
      CHECK(!overlap(entities[i], entities[k]));
    }
}

}  // namespace

TEST_CASE("boxes that are shown keep their places when others come and go") {
  Layout layout(in_a_row);
  auto four = entities({"b", "c", "d", "e"});
  layout.arrange(four, {});
  auto five = entities({"a", "b", "c", "d", "e"});
  layout.arrange(five, {calls("a", "c")});
  for (int i = 0; i < 4; ++i) CHECK(five[i + 1].x == four[i].x);
  check_no_overlap(five);
  auto three = entities({"a", "d", "e"});
  layout.arrange(three, {});
  CHECK(three[0].x == five[0].x);
  CHECK(three[2].x == five[4].x);
}

TEST_CASE("while a mission starts, all are placed anew, unless the user has moved one") {
  Layout layout(in_a_row);
  auto one = entities({"b"});
  layout.arrange(one, {});
  auto two = entities({"a", "b"});
  layout.arrange(two, {});
  CHECK(two[1].x == 300);
  layout.move("b", {17, 1000});
  auto four = entities({"a", "aa", "b", "c"});
  layout.arrange(four, {});
  CHECK(four[2].x == 17);
  CHECK(four[2].y == 1000);
  layout.forget();
  layout.arrange(four, {});
  CHECK(four[2].x == 600);
}

TEST_CASE(
    "once twice as many lines are known, all are placed anew, unless the user has moved one") {
  int placed = 0;
  Layout layout([&](const Drawing& drawing) { return ++placed, in_a_row(drawing); });
  auto five = entities({"a", "b", "c", "d", "e"});
  const std::vector<Link> few{calls("a", "b"), calls("b", "c")};
  std::vector<Link> many{few[0], few[1], calls("a", "c"), calls("a", "d"), calls("d", "e")};
  layout.arrange(five, few);
  layout.arrange(five, few);
  CHECK(placed == 1);
  layout.arrange(five, many);
  layout.arrange(five, many);
  CHECK(placed == 2);
  layout.move("a", {17, 17});
  for (const char* to : {"c", "d", "e"})
    for (const char* from : {"b", "e", "d", "c"})
      if (std::string(from) != to) many.push_back(calls(from, to));
  layout.arrange(five, many);
  CHECK(placed == 2);
}

TEST_CASE("to move a box that is not there does nothing") {
  Layout layout(in_a_row);
  layout.move("nobody", {1, 1});
  auto one = entities({"a"});
  layout.arrange(one, {});
  CHECK(one[0].x == 0);
}

TEST_CASE("without Graphviz boxes stand in rows, and the reason is told") {
  Layout layout([](const Drawing&) -> std::vector<Place> { throw skein::Unavailable("no dot"); });
  std::vector<std::string> names;
  for (int i = 0; i < 40; ++i) names.push_back("e" + std::to_string(i));
  auto all = entities(names);
  layout.arrange(all, {});
  CHECK(layout.failure() == "no dot");
  check_no_overlap(all);
}

TEST_CASE("Graphviz places callers beside those that they call, and loose boxes below") {
  Layout layout;
  auto all = entities({"a", "b", "c", "loose"});
  layout.arrange(all, {calls("a", "b"), calls("b", "c")});
  if (!layout.failure().empty()) {
    WARN("not tested: " << layout.failure());
    return;
  }
  check_no_overlap(all);
  CHECK(all[3].y > std::max({all[0].y, all[1].y, all[2].y}));
}

TEST_CASE("three hundred boxes are placed in time, and none covers another") {
  const int systems = GENERATE(1, 23);
  std::vector<std::string> names;
  for (int i = 0; i < 300; ++i) names.push_back("entity " + std::to_string(i));
  auto all = entities(names);
  for (int i = 0; i < 300; ++i) all[i].system = "uav-" + std::to_string(i % systems);
  std::vector<Link> links;
  for (int i = 0; i < 1000; ++i)
    links.push_back(calls(names[i * 7 % 300], names[(i * 7 + systems * (1 + i % 13)) % 300]));
  Layout layout;
  layout.arrange(all, links);
  CHECK((layout.failure().empty() || layout.failure().find("install") != std::string::npos));
  check_no_overlap(all);
}

TEST_CASE("systems stand side by side") {
  auto all = entities({"a", "b", "c", "d"});
  all[2].system = all[3].system = "uav-2";
  Layout layout;
  layout.arrange(all, {calls("a", "b"), calls("c", "d"), calls("a", "d")});
  const bool beside = std::max(all[0].x, all[1].x) + all[0].width < std::min(all[2].x, all[3].x);
  const bool below = std::max(all[0].y, all[1].y) + all[0].height < std::min(all[2].y, all[3].y);
  CHECK((beside || below || !layout.failure().empty()));
}
