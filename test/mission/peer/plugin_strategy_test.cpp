#include <catch2/catch.hpp>

#include "crew_profile.hpp"
#include "dds/port/vendor_names.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/mission_run.hpp"

using namespace skein::test;
using Catch::Contains;

TEST_CASE("a strategy that a plugin brings can be a profile's default") {
  const std::string vendor = GENERATE(from_range(skein::dds::networked_vendors()));
  if (!installed(vendor)) return;
  const CrewProfile profile(vendor, "strategy='humblest'", "process='in'", "caller");
  const MissionRun run(profile.file());
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("sound did it"));
}

TEST_CASE("a strategy that no plugin brings starts nothing, and the known ones are named") {
  const std::string vendor = GENERATE(from_range(skein::dds::networked_vendors()));
  if (!installed(vendor)) return;
  const CrewProfile profile(vendor, "strategy='humblst'", "process='in'", "caller");
  const MissionRun run(profile.file());
  INFO(run.output());
  CHECK(run.exit_code() == 78);
  CHECK_THAT(
      run.output(),
      Contains("unknown selection strategy 'humblst' (did you mean 'humblest'?); there are: ") &&
          Contains(" humblest, "));
}
