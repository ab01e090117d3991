// The program skein-grid.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

#include "profile/temporary_folder.hpp"
#include "tools/places.hpp"

using Catch::Contains;

namespace {

constexpr int kSide = 2000;

struct Run {
  int code = -1;
  std::string output{};
};

Run run(const std::string& shell) {
  Run run;
  std::FILE* const pipe = popen((shell + " 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) run.output += static_cast<char>(c);
  run.code = WEXITSTATUS(pclose(pipe));
  return run;
}

/// What skein-grid makes of a large empty map, with so much address space.
Run plan(const TemporaryFolder& folder, const std::string& kibibytes) {
  const std::string side = std::to_string(kSide);
  std::string rows;
  for (int y = 0; y < kSide; ++y) rows += std::string(kSide, '.') + '\n';
  const auto map = folder.write(
      "plain.map", "type octile\nheight " + side + "\nwidth " + side + "\nmap\n" + rows);
  const auto scenarios = folder.write(
      "plain.scen", "version 1\n0\tplain.map\t" + side + '\t' + side + "\t0\t0\t9\t0\t9\n");
  return run("ulimit -v " + kibibytes + "; exec '" + skein::test::built_program("skein-grid") +
             "' '" + map.string() + "' '" + scenarios.string() + "'");
}

}  // namespace

TEST_CASE("Who has not the memory for a map is told so, with what may help") {
  const TemporaryFolder folder;
  const Run with_enough = plan(folder, "unlimited");
  CAPTURE(with_enough.output);
  CHECK(with_enough.code == 0);
  CHECK_THAT(with_enough.output, Contains("optimal 1"));

  const Run without = plan(folder, "24000");
  CAPTURE(without.output);
  CHECK(without.code == 2);
  CHECK_THAT(without.output,
             Contains("skein-grid: there is not enough memory for ") && Contains("ulimit -v"));
}
