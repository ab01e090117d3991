// The program skein-grid.
#include <catch2/catch.hpp>
#include <string>

#include "test/tools/places.hpp"
#include "test/tools/shell.hpp"
#include "test/tools/temporary_folder.hpp"

using Catch::Contains;

namespace {

constexpr int kSide = 2000;

/// What skein-grid makes of a large empty map, with so much address space.
skein::test::ShellResult plan(const TemporaryFolder& folder, const std::string& kibibytes) {
  const std::string side = std::to_string(kSide);
  std::string rows;
  for (int y = 0; y < kSide; ++y) rows += std::string(kSide, '.') + '\n';
  const auto map = folder.write(
      "plain.map", "type octile\nheight " + side + "\nwidth " + side + "\nmap\n" + rows);
  const auto scenarios = folder.write(
      "plain.scen", "version 1\n0\tplain.map\t" + side + '\t' + side + "\t0\t0\t9\t0\t9\n");
  return skein::test::shell("ulimit -v " + kibibytes + "; exec '" +
                            skein::test::built_program("skein-grid") + "' '" + map.string() +
                            "' '" + scenarios.string() + "'");
}

}  // namespace

TEST_CASE("Who has not the memory for a map is told so, with what may help") {
  const TemporaryFolder folder;
  const auto with_enough = plan(folder, "unlimited");
  CAPTURE(with_enough.output);
  CHECK(with_enough.exit_code == 0);
  CHECK_THAT(with_enough.output, Contains("optimal 1"));

  const auto without = plan(folder, "24000");
  CAPTURE(without.output);
  CHECK(without.exit_code == 2);
  CHECK_THAT(without.output,
             Contains("skein-grid: there is not enough memory for ") && Contains("ulimit -v"));
}
