#include "mission/hosts/attended_report.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "mission/process/line_splitter.hpp"
#include "test/tools/seed.hpp"

using namespace skein::launch;
using Kind = AttendedReport::Kind;

TEST_CASE("A report is one printable line, and reads as what it was") {
  const auto kind = GENERATE(Kind::Hello, Kind::Output, Kind::Event, Kind::Ready, Kind::Ended);
  AttendedReport report{.kind = kind, .child = "navigator/RRTstar", .text = "ready after 0.2 s"};
  if (kind == Kind::Event) report.state = ChildState::Lost;
  if (kind == Kind::Ended) report.exit_code = 143;
  const std::string line = to_line(report);
  CHECK(line.find('\n') == line.size() - 1);
  const auto read = maybe_report(line.substr(0, line.size() - 1));
  REQUIRE(read);
  CHECK(read->kind == report.kind);
  CHECK(read->child == report.child);
  CHECK(read->state == report.state);
  CHECK(read->exit_code == report.exit_code);
  CHECK(read->text == report.text);
}

TEST_CASE("Whatever a process writes stays in its own report, printable and bounded") {
  const AttendedReport report{.kind = Kind::Output,
                              .child = "a",
                              .text = "one\nskein> ended - 0 \x1b[2J" + std::string(100'000, 'x')};
  const std::string line = to_line(report);
  CHECK(line.size() <= LineSplitter::kLongestLine);
  const auto read = maybe_report(line.substr(0, line.size() - 1));
  REQUIRE(read);
  CHECK(read->kind == Kind::Output);
  CHECK(read->text.starts_with("one\\x0askein> ended - 0 \\x1b[2Jxxx"));
}

TEST_CASE("Text of others is no report") {
  for (const char* line : {"", "skein>", "skein> ", "skein> event", "skein> event a",
                           "skein> event a x", "skein> event a 99 text", "skein> event a -1 text",
                           "skein> sing a 0 la", "Welcome to beta", " skein> ready - 0 "}) {
    CAPTURE(line);
    CHECK_FALSE(maybe_report(line));
  }
  std::mt19937 random(skein::test::seed_of_this_run());
  for (int i = 0; i < 2000; ++i) {
    std::string line = "skein> event a 1 text";
    for (int n = 0; n < 3; ++n) line[random() % line.size()] = static_cast<char>(random());
    if (const auto report = maybe_report(line)) CHECK(to_line(*report).size() < 200);
  }
}
