#include <catch2/catch.hpp>

#include "crew_profile.hpp"
#include "dds/port/vendor_names.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/mission_run.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

// Of `moody`, which has a process of its own.
std::string own(const std::string& vendor, const std::string& restart) {
  return "process='own' restart='" + restart + "' vendor='" + vendor + "'";
}

void check_that_it_comes_back(const std::string& owner, const std::string& csp) {
  if (!installed(owner) || !installed(csp)) return;
  CAPTURE(owner, csp);
  const CrewProfile profile(owner, "", own(csp, "on-failure"), "client");
  const MissionRun run(profile.file());
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  for (const std::string trouble : {"hang", "stop", "stop beyond its lease"}) {
    CHECK_THAT(run.output(), Contains("sound did " + trouble));
    CHECK_THAT(run.output(), Contains("after " + trouble + " moody works again"));
  }
  CHECK_THAT(run.output(), Contains("hangs and was killed, for the launcher to start it again"));
  CHECK_THAT(run.output(), Contains("is stopped, was not heard of for its lease and was killed"));
  CHECK_THAT(run.output(), Contains("office/moody: ended by signal 9"));
}

}  // namespace

TEST_CASE(
    "a CSP that hangs, or was stopped, is killed by its owner's peer, brought back by the "
    "launcher, and works again") {
  const std::string owner = GENERATE(from_range(skein::dds::networked_vendors()));
  for (const std::string& csp : skein::dds::networked_vendors()) {
    if (csp != owner) check_that_it_comes_back(owner, csp);
  }
}

TEST_CASE("a CSP of its owner's vendor that hangs is brought back, too", "[long]") {
  const std::string vendor = GENERATE(from_range(skein::dds::networked_vendors()));
  check_that_it_comes_back(vendor, vendor);
}

TEST_CASE("a CSP that nobody would start again is left alone") {
  const std::string vendor = GENERATE(from_range(skein::dds::networked_vendors()));
  if (!installed(vendor)) return;
  const CrewProfile profile(vendor, "", own(vendor, "never"), "client");
  const MissionRun run(profile.file());
  INFO(run.output());
  CHECK(run.exit_code() == 2);
  CHECK_THAT(run.output(), Contains("sound did hang"));
  CHECK_THAT(run.output(), !Contains("was killed"));
}

TEST_CASE("a peer that is in a call when the mission ends ends in time") {
  const std::string vendor = GENERATE(from_range(skein::dds::networked_vendors()));
  if (!installed(vendor)) return;
  const CrewProfile profile(vendor, "", "process='in'", "leaver",
                            "<peer name='visitor' component='visitor.xml'/>");
  const MissionRun run(profile.file());
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("the visitor goes: "));
  CHECK_THAT(run.output(), !Contains("kill"));
}

TEST_CASE("what a Head has learned is written though a CSP hangs at the mission's end") {
  const std::string vendor = GENERATE(from_range(skein::dds::networked_vendors()));
  if (!installed(vendor)) return;
  const CrewProfile profile(vendor, "history='learned.json' stop_timeout='1 s'", "process='in'",
                            "hanger");
  const MissionRun run(profile.file());
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("office: did not end within 1.00 s: killed"));
  CHECK(std::filesystem::exists(run.file("learned.json")));
}
