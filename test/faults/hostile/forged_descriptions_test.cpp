#include <catch2/catch.hpp>

#include "rogue.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using brokerless_discovery::Room;
using ::test::LouderEcho;

TEST_CASE("a stranger withdraws nobody else's service, and takes none with him by claiming it",
          "[R23]") {
  dds::Vendor& vendor = vendor_of_rogue();
  Scene scene;
  auto rogue = std::make_unique<Rogue>(vendor);
  ServiceDescription victim;
  for (const auto& known : scene.client->broker().all()) victim = *known;
  REQUIRE(victim.provider == scene.service.id().bytes);
  const auto marker = rogue->describe(1, "marker");

  // One after the other has arrived: of one instance a writer keeps the newest sample only.
  rogue->write(marker);
  REQUIRE(scene.all_know(marker));
  rogue->withdraw(scene.service.id());
  CHECK(scene.all_refused(Refusal::Forged, 1));
  auto claimed = victim;
  claimed.process = "";
  rogue->write(claimed);
  CHECK(scene.all_refused(Refusal::Forged, 2));
  rogue->write(rogue->describe(3, "thief"), scene.service.id());
  CHECK(scene.all_refused(Refusal::Forged, 3));
  auto suicide = rogue->describe(4, "suicide");
  suicide.host = victim.host;
  suicide.process = victim.process;
  rogue->write(suicide);
  CHECK(scene.all_refused(Refusal::Forged, 4));
  rogue->write(claimed, {rogue->describe(2, "").provider});
  CHECK(scene.all_refused(Refusal::Malformed, 1));
  CHECK(scene.all_know(victim));
  CHECK(scene.client->broker().all().size() == 2);
  CHECK(scene.echo.within(20s).echo("x") == "x");

  rogue.reset();
  REQUIRE(scene.all_know(marker, false));
  CHECK(scene.all_know(victim));
  CHECK(scene.echo.within(20s).echo("x") == "x");
  CHECK(scene.client->connect<LouderEcho>({.timeout = 20s}).echo("new") == "new");
  const auto late = entity_with_lease("late", Pairing::get().client, 1000ms);
  CHECK(late->connect<LouderEcho>({.timeout = 20s}).echo("late") == "late");
}

TEST_CASE(
    "a flood of one participant's descriptions fills its own room and no more, and goes with it",
    "[R26]") {
  constexpr std::uint32_t kFlood = 3000;
  dds::Vendor& vendor = vendor_of_rogue();
  Scene scene;
  auto rogue = std::make_unique<Rogue>(vendor);
  for (std::uint32_t i = 1; i <= kFlood; ++i) {
    rogue->write(rogue->describe(i, "flood" + std::to_string(i)));
  }
  CHECK(scene.all([&](auto& broker) {
    return broker.refused(Refusal::NoRoom) >= kFlood - Room::kEntriesOfOne;
  }));
  CHECK(scene.all([](auto& broker) { return broker.all().size() == Room::kEntriesOfOne + 1; }));
  CHECK(scene.echo.within(20s).echo("x") == "x");

  const auto another = std::make_unique<Rogue>(vendor);
  const auto marker = another->describe(1, "marker");
  another->write(marker);
  CHECK(scene.all_know(marker));
  rogue.reset();
  CHECK(scene.all([](auto& broker) { return broker.all().size() == 2; }));
  CHECK(scene.echo.within(20s).echo("x") == "x");
}
