#include "view/live_view.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "report_scene.hpp"

namespace live_view_test {

using namespace reconnaissance;
using Catch::Contains;
using reconnaissance::test::flown_mission;

namespace {

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

bool is_ascii(const std::string& line) {
  return std::ranges::all_of(line, [](unsigned char c) { return c >= 0x20 && c < 0x7f; });
}

}  // namespace

TEST_CASE("a frame of the live view fits the terminal, whatever is told") {
  MissionRecord record = flown_mission();
  std::string hostile = "a\x1b[2Jb\n\xff\xfe\x07";
  hostile.append(500, 'x');
  for (Stage& each : record.phases) each.reason = hostile;
  for (Target& each : record.targets) each.name = std::string(500, '\t');
  const std::vector<MemberState> members(30, {hostile, "Degraded\r\n"});
  for (const std::size_t columns : {60, 80, 200}) {
    for (const std::size_t lines : {12, 24, 70}) {
      const auto view = live_view(record, members, columns, lines);
      CHECK(view.size() <= lines);
      for (const std::string& line : view) {
        CHECK(line.size() <= columns);
        CHECK(is_ascii(line));
      }
    }
  }
  CHECK(live_view(record, members, 1, 1).size() <= 12);
}

TEST_CASE("the live view shows who is where, how everybody is, and what was decided last") {
  MissionRecord record = flown_mission();
  const auto view = live_view(record, {{"navigator", "Fine"}, {"nhp", "SILENT"}}, 100, 40);
  const std::string text = text_of(view);
  CHECK_THAT(view.front(), Contains("fuel"));
  CHECK_THAT(text, Contains("navigator          Fine"));
  CHECK_THAT(text, Contains("nhp                SILENT"));
  CHECK_THAT(text, Contains("X"));
  for (const Target& target : record.targets) CHECK_THAT(text, Contains(target.name));
  CHECK_THAT(text, Contains(record.phases.back().name));
}

TEST_CASE("the aircraft points to where it flies") {
  MissionRecord record;
  record.track.push_back({10, {0, 0, 500}, 300, 60, 60, 0, 0, 0, 70});
  const auto sign_at = [&](double heading_rad) {
    record.track.back().heading_rad = heading_rad;
    const auto view = live_view(record, {}, 80, 24);
    std::string signs;
    for (std::size_t row = 2; row + 5 < view.size(); ++row)
      for (const char c : view[row])
        if (c != ' ') signs += c;
    return signs;
  };
  CHECK(sign_at(0) == "^");
  CHECK(sign_at(1.6) == ">");
  CHECK(sign_at(3.1) == "v");
  CHECK(sign_at(-1.5) == "<");
  CHECK(sign_at(4.8) == "<");
}

TEST_CASE("before anything is known the live view says so") {
  const auto view = live_view({}, {}, 80, 24);
  CHECK_THAT(view.front(), Contains("has not begun"));
}

}  // namespace live_view_test
