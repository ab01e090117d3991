#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "command/doctor/diagnosis.hpp"

// Machines that do not exist, for the doctor.
namespace skein::test {

/// One on which nothing is wrong.
inline command::doctor::Facts sound_machine() {
  using namespace command::doctor;
  constexpr std::uint64_t kMiB = 1 << 20;
  Facts facts;
  facts.interfaces = {{"lo", {"127.0.0.1"}, true, false}, {"eth0", {"10.0.0.2"}, true, true}};
  facts.buffer = 4 * kMiB;
  facts.vendors = {{"fastdds", "", "libfastrtps.so.2.9.1", "2.9.1", {"2.9.1"}},
                   {"cyclonedds", "", "libddsc.so.0.10.2", "0.10.2", {"0.10.2", "0.10.5"}}};
  facts.synchronised_clock = true;
  facts.free_shared_memory = 1024 * kMiB;
  facts.firewall = "";
  facts.limits = {1024, std::nullopt, 99};
  return facts;
}

/// What was found about a thing; the test fails unless it is one finding.
inline command::doctor::Symptom only(const command::doctor::Symptoms& symptoms,
                                     const std::string& about) {
  const command::doctor::Symptom* found = nullptr;
  for (const auto& symptom : symptoms) {
    if (symptom.about != about) continue;
    INFO("two findings about " << about << ": " << symptom.cause);
    REQUIRE(!found);
    found = &symptom;
  }
  INFO("no finding about " << about);
  REQUIRE(found);
  return *found;
}

}  // namespace skein::test
