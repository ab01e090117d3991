// What the doctor concludes about the system beside its network, of machines that do not exist.
#include "machines.hpp"

using namespace skein::command::doctor;
using Catch::Contains;
using skein::test::only;
using skein::test::sound_machine;

namespace {

constexpr std::uint64_t kMiB = 1 << 20;

}  // namespace

TEST_CASE(
    "a vendor that is missing is an error where the mission uses it, or where there is no other") {
  Facts facts = sound_machine();
  facts.vendors[0].failure = "no libskein_fastdds.so";
  Symptom symptom = only(diagnose_system({}, facts), "fastdds");
  CHECK(symptom.severity == Severity::Warning);
  CHECK(symptom.evidence == "no libskein_fastdds.so");
  Purpose purpose;
  purpose.vendors = {"fastdds"};
  CHECK(only(diagnose_system(purpose, facts), "fastdds").severity == Severity::Error);
  facts.vendors[1].failure = "no libskein_cyclonedds.so";
  CHECK(only(diagnose_system({}, facts), "fastdds").severity == Severity::Error);
}

TEST_CASE("another version of a vendor than the tested one is a warning") {
  Facts facts = sound_machine();
  facts.vendors[1].version = "0.10.5";
  CHECK(only(diagnose_system({}, facts), "cyclonedds").severity == Severity::Fine);
  facts.vendors[1].version = "0.11.0";
  const Symptom symptom = only(diagnose_system({}, facts), "cyclonedds");
  CHECK(symptom.severity == Severity::Warning);
  CHECK_THAT(symptom.cause,
             Contains("tested with version 0.10.2 or 0.10.5") && Contains("this is 0.11.0"));
}

TEST_CASE("a clock that is not synchronised matters between hosts") {
  Facts facts = sound_machine();
  facts.synchronised_clock = false;
  CHECK(only(diagnose_system({}, facts), "clock").severity == Severity::Note);
  Purpose purpose;
  SECTION("on an interface") { purpose.interfaces = {"eth0"}; }
  SECTION("with peers elsewhere") { purpose.several_hosts = true; }
  CHECK(only(diagnose_system(purpose, facts), "clock").severity == Severity::Warning);
}

TEST_CASE("shared memory without room matters to missions that use it") {
  Facts facts = sound_machine();
  facts.free_shared_memory = 16 * kMiB;
  CHECK(worst_of(diagnose_system({}, facts)) == Severity::Note);
  Purpose purpose;
  purpose.shared_memory = true;
  CHECK(worst_of(diagnose_system(purpose, facts)) == Severity::Warning);
  facts.free_shared_memory = std::nullopt;
  CHECK(worst_of(diagnose_system(purpose, facts)) == Severity::Error);
}

TEST_CASE("few files, no priority and no locked memory are each a warning") {
  Facts facts = sound_machine();
  Purpose purpose;
  std::string evidence;
  SECTION("files") {
    facts.limits.open_files = 256;
    evidence = "ulimit -n";
  }
  SECTION("priority") {
    facts.limits.real_time_priority = 0;
    purpose.priority = 80;
    evidence = "ulimit -r";
  }
  SECTION("locked memory") {
    facts.limits.locked_memory = 8 * kMiB;
    purpose.locks_memory = true;
    evidence = "ulimit -l";
  }
  const Symptom symptom = only(diagnose_system(purpose, facts), "limits");
  CHECK(symptom.severity == Severity::Warning);
  CHECK(symptom.evidence == evidence);
}

TEST_CASE("limits on what the mission does not ask for are none") {
  Facts facts = sound_machine();
  facts.limits.real_time_priority = 0;
  facts.limits.locked_memory = 0;
  CHECK(only(diagnose_system({}, facts), "limits").severity == Severity::Fine);
}
