#include "mission/process/exit_codes.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "test/tools/places.hpp"

using namespace skein::launch;
using skein::test::project_file;

TEST_CASE("The documentation lists every exit code of a launch, in the same words") {
  std::ostringstream text;
  text << std::ifstream(project_file("mission_profiles/README.md")).rdbuf();
  for (const ExitCode& entry : kExitCodes) {
    const std::string row =
        "| " + std::string(entry.code) + " | " + std::string(entry.meaning) + " |";
    CAPTURE(row);
    CHECK(text.str().find(row) != std::string::npos);
  }
}
