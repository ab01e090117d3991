#include <catch2/catch.hpp>
#include <cstdio>

#include "site.hpp"
#include "skein/error.hpp"
#include "skein/gather.hpp"
#include "test/tools/eventually.hpp"

using namespace std::chrono_literals;
using skein::test::eventually;

namespace {

/// A second drone, which is slower. It comes first in the order of names.
struct TwoDrones : Site {
  TwoDrones() {
    drone.provide<survey::ISurveyor>(std::make_shared<Surveyor>(),
                                     {.attributes = {{"latency", "100"}}});
    other->provide<survey::ISurveyor>(std::make_shared<Surveyor>(),
                                      {.attributes = {{"latency", "500"}}});
    REQUIRE(eventually([&] { return station.connect_all<survey::ISurveyor>().size() == 2; }));
  }
  std::unique_ptr<skein::Entity> other =
      std::make_unique<skein::Entity>(skein::EntityOptions{.name = "another", .vendor = vendor});
};

}  // namespace

TEST_CASE("a connection goes to a provider that declares what is asked for") {
  TwoDrones site;
  skein::Entity& station = site.station;

  auto surveyor = station.connect<survey::ISurveyor>({
      .constraints = {{"latency", skein::Relation::AtMost, "300"}},
      .preferred_host = skein::ConnectOptions::kOwnHost,
      .hedge_after = 50ms,
      .timeout = 10s,
  });

  CHECK(surveyor.within(30s).minutes(kField) == 24);
  CHECK_THROWS_WITH(
      station.connect<survey::ISurveyor>(
          {.constraints = {{"latency", skein::Relation::AtMost, "50"}}, .timeout = 50ms}),
      Catch::Contains("its latency is 100, not at most 50"));
}

TEST_CASE("a call to an idempotent operation moves to the next provider") {
  TwoDrones site;
  auto surveyor = site.station.connect<survey::ISurveyor>();
  CHECK(surveyor.within(30s).minutes(kField) == 24);
  site.other.reset();
  CHECK(surveyor.within(30s).minutes(kField) == 24);
}

TEST_CASE("all providers can be asked at once") {
  TwoDrones site;
  skein::Entity& station = site.station;

  auto all = station.connect_all<survey::ISurveyor>();
  const auto answers = skein::gather(all, all.size(), [](survey::ISurveyor::Proxy& surveyor) {
    return surveyor.within(30s).async_minutes(kField);
  });
  for (const auto& answer : answers) {
    if (answer.result) std::printf("%s: %.0f minutes\n", answer.entity.c_str(), *answer.result);
  }

  REQUIRE(answers.size() == 2);
  for (const auto& answer : answers) CHECK(answer.result == 24.0);
}
