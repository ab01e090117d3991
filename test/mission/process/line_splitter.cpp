#include "mission/process/line_splitter.hpp"

#include <catch2/catch.hpp>
#include <vector>

using skein::launch::LineSplitter;

namespace {

std::vector<std::string> lines_of(const std::vector<std::string>& pieces) {
  std::vector<std::string> lines;
  const auto collect = [&](std::string_view line) { lines.emplace_back(line); };
  LineSplitter splitter;
  for (const auto& piece : pieces) splitter.add(piece, collect);
  splitter.finish(collect);
  return lines;
}

}  // namespace

TEST_CASE("Lines are the same however the bytes come in") {
  const std::vector<std::string> expected{"one", "", "three", "rest"};
  CHECK(lines_of({"one\n\nthree\r\nrest"}) == expected);
  CHECK(lines_of({"o", "ne", "\n", "\nth", "ree\r", "\n", "re", "st"}) == expected);
}

TEST_CASE("Nothing becomes no line") { CHECK(lines_of({"", ""}).empty()); }

TEST_CASE("A line that does not end is cut, and none of it is lost") {
  const std::string longest(LineSplitter::kLongestLine, 'a');
  CHECK(lines_of({longest + longest + "b\nc"}) ==
        std::vector<std::string>{longest, longest, "b", "c"});
  CHECK(lines_of({longest, "\n", "c\n"}) == std::vector<std::string>{longest, "c"});
}
