#include "entity/statistics_topic.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "skein/introspection.idl.hpp"
#include "skein/loopback.hpp"

using namespace skein;
using namespace std::chrono_literals;
using introspection::ServiceStatistics;
using introspection::StatisticsReader;
using introspection::StatisticsTopic;

namespace {

/// An entity of one service, and one that may read, on a network on which time passes only when
/// told.
struct World {
  void pass(Duration time) {
    clock.advance(time);
    control.run_all();
  }
  /// What has happened since is done.
  void settle() { pass(Duration::zero()); }

  std::vector<ServiceStatistics> tell() {
    ServiceStatistics statistics;
    statistics.provider = near->guid().bytes;
    statistics.waiting = ++asked;
    return {statistics};
  }

  ManualClock clock;
  ManualExecutor control;
  dds::LoopbackNetwork network{clock};
  std::unique_ptr<dds::Participant> near = network.vendor()->create_participant({});
  std::unique_ptr<dds::Participant> far = network.vendor()->create_participant({});
  std::uint32_t asked = 0;
  std::optional<StatisticsTopic> topic{std::in_place, *near, clock, control,
                                       [this] { return tell(); }};
  std::optional<StatisticsReader> reader;
};

}  // namespace

TEST_CASE("while somebody reads statistics, they are told at once and then each second") {
  World world;
  world.pass(10s);
  CHECK(world.asked == 0);
  world.reader.emplace(*world.far);
  world.settle();
  CHECK(world.asked == 1);
  REQUIRE(world.reader->latest().size() == 1);
  CHECK(world.reader->latest()[0].waiting == 1);
  world.pass(999ms);
  CHECK(world.asked == 1);
  world.pass(1ms);
  CHECK(world.asked == 2);
  CHECK(world.reader->latest()[0].waiting == 2);
  CHECK(world.reader->refused() == 0);
}

TEST_CASE("nobody is asked for statistics that nobody reads any more") {
  World world;
  world.reader.emplace(*world.far);
  world.settle();
  world.reader.reset();
  world.pass(1s);
  world.pass(10s);
  CHECK(world.asked == 1);
  world.reader.emplace(*world.far);
  world.settle();
  CHECK(world.asked == 2);
}

TEST_CASE("statistics keep their pace for a reader that comes right after another") {
  World world;
  world.reader.emplace(*world.far);
  world.settle();
  world.reader.reset();
  world.reader.emplace(*world.far);
  world.settle();
  CHECK(world.asked == 1);
  for (int i = 0; i < 3; ++i) world.pass(1s);
  CHECK(world.asked == 4);
}

TEST_CASE("statistics are not asked for once their topic has gone") {
  World world;
  world.reader.emplace(*world.far);
  SECTION("before they were asked for") {}
  SECTION("between two times") { world.settle(); }
  SECTION("when it was just due") {
    world.settle();
    world.clock.advance(1s);
  }
  const std::uint32_t asked = world.asked;
  world.topic.reset();
  CHECK(world.reader->latest().empty());
  world.pass(10s);
  CHECK(world.asked == asked);
}
