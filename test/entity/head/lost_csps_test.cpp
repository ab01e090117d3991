#include "entity/head/lost_csps.hpp"

#include <catch2/catch.hpp>

using namespace skein;
using namespace std::chrono_literals;
using brokerless_discovery::Absence;
using brokerless_discovery::Departure;
using entity::LostCsps;

namespace {

constexpr Instant kNow{1h};

const auto kKnown = [](const Guid&) { return true; };
const auto kUnknown = [](const Guid&) { return false; };

Candidate csp(const std::string& name) {
  Candidate candidate;
  candidate.name = name;
  return candidate;
}

Absence absent(const std::string& name, Departure how) {
  return {"crew::Worker", name, how, kNow, 1};
}

}  // namespace

TEST_CASE("a CSP that died is awaited for ten seconds, one that left is not") {
  const LostCsps none("");
  CHECK(none.awaited({}, kKnown) < kNow);
  CHECK(none.awaited({absent("a", Departure::Left)}, kKnown) < kNow);
  CHECK(none.awaited({absent("a", Departure::Died)}, kKnown) == kNow + 10s);
}

TEST_CASE("a CSP that was lost is awaited for a second while the Broker has not heard of it") {
  LostCsps lost("");
  CHECK(lost.empty());
  lost.add(csp("a"), kNow);
  CHECK_FALSE(lost.empty());
  CHECK(lost.awaited({}, kKnown) == kNow + 1s);
  CHECK(lost.awaited({}, kUnknown) < kNow);
}

TEST_CASE("a CSP that one request has lost twice is not awaited") {
  LostCsps lost("");
  lost.add(csp("a"), kNow);
  CHECK_FALSE(lost.is_worn_out("a"));
  lost.add(csp("a"), kNow + 1s);
  CHECK(lost.is_worn_out("a"));
  CHECK_FALSE(lost.is_worn_out("b"));
  CHECK(lost.awaited({absent("a", Departure::Died)}, kKnown) < kNow);
  CHECK(lost.awaited({absent("b", Departure::Died)}, kKnown) == kNow + 10s);
}

TEST_CASE("a task for one CSP awaits no other") {
  LostCsps lost("a");
  lost.add(csp("b"), kNow);
  CHECK(lost.awaited({absent("b", Departure::Died)}, kKnown) < kNow);
  CHECK(lost.awaited({absent("a", Departure::Died)}, kKnown) == kNow + 10s);
}
