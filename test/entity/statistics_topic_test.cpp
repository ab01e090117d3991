#include "entity/statistics_topic.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "entity/periodic_topic.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/loopback.hpp"

using namespace skein;
using namespace std::chrono_literals;
using introspection::PeriodicTopic;
using introspection::ServiceStatistics;
using introspection::StatisticsReader;

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

  std::vector<ServiceStatistics> tell(bool anew) {
    begun += anew ? 1 : 0;
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
  int begun = 0;  // how often a reader was told to be the first
  std::optional<PeriodicTopic<ServiceStatistics>> topic{std::in_place,
                                                        *near,
                                                        clock,
                                                        control,
                                                        introspection::kTopic<ServiceStatistics>,
                                                        [this](bool anew) { return tell(anew); }};
  std::optional<StatisticsReader> reader;
};

}  // namespace

TEST_CASE_METHOD(World,
                 "while somebody reads statistics, they are told at once and then each second") {
  pass(10s);
  CHECK(asked == 0);
  reader.emplace(*far);
  settle();
  CHECK(asked == 1);
  REQUIRE(reader->latest().size() == 1);
  CHECK(reader->latest()[0].waiting == 1);
  pass(999ms);
  CHECK(asked == 1);
  pass(1ms);
  CHECK(asked == 2);
  CHECK(reader->latest()[0].waiting == 2);
  CHECK(reader->refused() == 0);
}

TEST_CASE_METHOD(World, "nobody is asked for statistics that nobody reads any more") {
  reader.emplace(*far);
  settle();
  reader.reset();
  pass(1s);
  pass(10s);
  CHECK(asked == 1);
  CHECK(begun == 1);
  reader.emplace(*far);
  settle();
  CHECK(asked == 2);
  CHECK(begun == 2);
}

TEST_CASE_METHOD(World, "statistics keep their pace for a reader that comes right after another") {
  reader.emplace(*far);
  settle();
  reader.reset();
  reader.emplace(*far);
  settle();
  CHECK(asked == 1);
  for (int i = 0; i < 3; ++i) pass(1s);
  CHECK(asked == 4);
}

TEST_CASE_METHOD(World, "statistics are not asked for once their topic has gone") {
  reader.emplace(*far);
  SECTION("before they were asked for") {}
  SECTION("between two times") { settle(); }
  SECTION("when it was just due") {
    settle();
    clock.advance(1s);
  }
  const std::uint32_t before = asked;
  topic.reset();
  CHECK(reader->latest().empty());
  pass(10s);
  CHECK(asked == before);
}
