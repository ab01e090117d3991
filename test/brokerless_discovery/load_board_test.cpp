#include "brokerless_discovery/load_board.hpp"

#include <catch2/catch.hpp>

#include "descriptions.hpp"
#include "skein/loopback.hpp"

using namespace skein;
using namespace skein::brokerless_discovery;
using namespace std::chrono_literals;
using skein::test::guid;

namespace {

/// Two peers on a network on which time passes only when told, and what was written there.
struct Loads {
  Loads() {
    network.judge_transfers([this](const dds::Transfer& transfer) {
      if (transfer.topic == "skein/loads") ++written[transfer.writer];
      return dds::Fate::deliver();
    });
  }

  void pass(Duration time) {
    clock.advance(time);
    control.run_all();
  }

  std::size_t transfers() const {
    std::size_t count = 0;
    for (const auto& [writer, times] : written) count += times;
    return count;
  }

  ManualClock clock;
  ManualExecutor control;
  dds::LoopbackNetwork network{clock};
  std::map<Guid, std::size_t> written;
  std::unique_ptr<dds::Participant> near = network.vendor()->create_participant({});
  std::unique_ptr<dds::Participant> far = network.vendor()->create_participant({});
  const Guid id = guid(1, near->guid());  // of a provider there
  LoadBoard provider{*near, clock, control};
  LoadBoard client{*far, clock, control};
};

}  // namespace

TEST_CASE("everybody hears of a provider's load, its own peer too, and a late joiner", "[R21]") {
  Loads world;
  std::size_t load = 3;
  const auto told = world.provider.tell(world.id, [&] { return load; });
  CHECK(world.client.load_of(world.id) == 0);
  world.pass(LoadBoard::kInterval);
  CHECK(world.client.load_of(world.id) == 3);
  CHECK(world.provider.load_of(world.id) == 3);
  const auto participant = world.network.vendor()->create_participant({});
  const LoadBoard late(*participant, world.clock, world.control);
  CHECK(late.load_of(world.id) == 3);
  load = 0;
  world.provider.notifier()();
  world.pass(LoadBoard::kInterval);
  CHECK(world.client.load_of(world.id) == 0);
}

TEST_CASE("a load is told when it has changed, and at most once in an interval", "[R21]") {
  Loads world;
  std::size_t load = 0;
  const auto told = world.provider.tell(world.id, [&] { return load; });
  const auto change = world.provider.notifier();
  world.pass(10 * LoadBoard::kInterval);
  CHECK(world.transfers() == 0);
  load = 7;
  change();
  world.pass(LoadBoard::kInterval);
  const std::size_t once = world.transfers();
  CHECK(once == 2);  // to the two readers
  for (int i = 0; i < 20; ++i) {
    change();
    world.pass(LoadBoard::kInterval);
  }
  CHECK(world.transfers() == once);
  for (int i = 0; i < 10; ++i) {
    ++load;
    change();
    world.pass(LoadBoard::kInterval / 10);
  }
  CHECK(world.transfers() == 2 * once);
}

TEST_CASE("of a provider that has withdrawn, or whose peer is gone, no load is known", "[R21]") {
  Loads world;
  auto told = world.provider.tell(world.id, [] { return std::size_t{3}; });
  world.pass(LoadBoard::kInterval);
  REQUIRE(world.client.load_of(world.id) == 3);
  SECTION("it has withdrawn") { told.withdraw(); }
  SECTION("its peer is gone") {
    world.network.kill(world.near->guid());
    world.pass(10s);
  }
  CHECK(world.client.load_of(world.id) == 0);
}

TEST_CASE("a load that nobody says has changed is not even measured", "[R21]") {
  Loads world;
  std::size_t measured = 0;
  const auto told = world.provider.tell(world.id, [&] { return ++measured; });
  for (int i = 0; i < 20; ++i) world.pass(LoadBoard::kInterval);
  CHECK(measured == 1);
  world.provider.notifier()();
  for (int i = 0; i < 20; ++i) world.pass(LoadBoard::kInterval);
  CHECK(measured == 2);
}

TEST_CASE("a load may change after its board has gone", "[R21]") {
  std::function<void()> change;
  {
    Loads world;
    change = world.provider.notifier();
  }
  CHECK_NOTHROW(change());
}

TEST_CASE("nobody tells another provider's load, nor withdraws it", "[R21][R23]") {
  Loads world;
  const auto told = world.provider.tell(world.id, [] { return std::size_t{3}; });
  world.pass(LoadBoard::kInterval);
  const auto stranger = world.network.vendor()->create_participant({});
  LoadBoard forger(*stranger, world.clock, world.control);
  auto forged = forger.tell(world.id, [] { return std::size_t{0xFFFF}; });
  world.pass(LoadBoard::kInterval);
  CHECK(world.client.load_of(world.id) == 3);
  CHECK(world.client.refused() == 1);
  forged.withdraw();
  CHECK(world.client.load_of(world.id) == 3);
  CHECK(world.client.refused() == 2);
}

TEST_CASE("a participant's loads have so much room", "[R21][R26]") {
  Loads world;
  std::vector<Broker::Registration> told;
  for (std::size_t i = 0; i <= Room::kEntriesOfOne; ++i) {
    Guid provider = guid(static_cast<std::uint8_t>(i), world.near->guid());
    provider.bytes[13] = static_cast<std::uint8_t>(i >> 8);
    told.push_back(world.provider.tell(provider, [] { return std::size_t{1}; }));
  }
  world.pass(LoadBoard::kInterval);
  CHECK(world.client.refused() == 1);
}
