// The machine's wall clock is set while a mission is recorded.
#include <catch2/catch.hpp>

#include "recording/mcap/reader.hpp"
#include "recording/player.hpp"
#include "recording/recorded_types.hpp"
#include "recording/recorder.hpp"
#include "recording/recording_time.hpp"
#include "recordings.hpp"
#include "skein/describe.hpp"
#include "skein/detail/codec.hpp"
#include "skein/entity.hpp"
#include "survey.idl.hpp"
#include "test/dynamic/surveyor.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"
#include "test/tools/stepped_clock.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein;
using namespace std::chrono_literals;
using recording::ClockTimes, recording::RecordingTime;
using test::eventually, test::operator/;

namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::unique_ptr<Entity> participant_called(const std::string& name) {
  EntityOptions options;
  options.name = name;
  options.vendor = dds::load_vendor("loopback");
  options.domain = 21;
  return std::make_unique<Entity>(std::move(options));
}

/// Sets the wall clock, and back when it ends.
class SetClock {
 public:
  explicit SetClock(std::chrono::seconds by) : by_(by) { test::step_wall_clock(by_); }
  ~SetClock() { test::step_wall_clock(-by_); }
  SetClock(const SetClock&) = delete;

 private:
  const std::chrono::seconds by_;
};

std::uint64_t written(const recording::Recorder& recorder, const std::string& topic) {
  for (const auto& channel : recorder.statistics().channels)
    if (channel.topic == topic) return channel.written;
  return 0;
}

}  // namespace

TEST_CASE("a recording's time goes on as it began, and a set wall clock is told once") {
  RecordingTime time(ClockTimes{5 * kNanoseconds, 100 * kNanoseconds});
  CHECK(time.at(103 * kNanoseconds) == 8 * kNanoseconds);
  CHECK_FALSE(time.step({8 * kNanoseconds, 103 * kNanoseconds}));
  CHECK_FALSE(
      time.step({9 * kNanoseconds + 1000, 104 * kNanoseconds}));  // looked at one after the other
  CHECK(time.step({1000 * kNanoseconds, 105 * kNanoseconds}) == 990 * kNanoseconds);
  CHECK_FALSE(time.step({1001 * kNanoseconds, 106 * kNanoseconds}));
  CHECK(time.step({10 * kNanoseconds, 107 * kNanoseconds}) == -992 * kNanoseconds);
}

TEST_CASE("what is recorded while the wall clock is set stays in its order and pace") {
  const auto step = GENERATE(std::chrono::seconds(-3600), std::chrono::hours(24 * 365 * 56) + 0s);
  const TemporaryFolder folder;
  const auto provider = participant_called("surveyor"), watcher = participant_called("recorder");
  provider->provide<survey::ISurveyor>(std::make_shared<Surveyor>());
  auto proxy = provider->connect<survey::ISurveyor>();
  auto publisher = provider->publisher<survey::Corner>("corner");
  const SetClock early(step > 0s ? -step : 0s);
  recording::Recorder recorder(*watcher, folder / "a.mcap", {});
  REQUIRE(eventually([&] { return recorder.look(1s), publisher.subscribers() == 1; }));
  const auto record = [&](double x) {
    const auto before = written(recorder, "corner"),
               calls = written(recorder, "skein/call_records");
    publisher.publish({x, 1});
    proxy.greet("you");
    REQUIRE(eventually([&] {
      return recorder.look(1s), written(recorder, "corner") > before &&
                                    written(recorder, "skein/call_records") > calls;
    }));
  };
  record(1);
  {
    const SetClock set(step);
    record(2);
    recorder.close();
  }

  const recording::Reader reader(folder / "a.mcap");
  const auto [first, last] = reader.times().value();
  CHECK(last - first < 60 * kNanoseconds);
  const auto steps = reader.clock_steps();
  REQUIRE(steps.size() == 1);
  CHECK(std::abs(steps[0].by - std::chrono::nanoseconds(step).count()) < kNanoseconds);
  CHECK((steps[0].at >= first && steps[0].at - first < 60 * kNanoseconds));
  std::vector<double> seen;
  auto messages = reader.messages({.topics = {"corner"}});
  while (const auto message = messages.next())
    seen.push_back(idl::decode_message<survey::Corner>(message->data).x);
  CHECK(seen == std::vector<double>{1, 2});
}

TEST_CASE("a replay leaves out the years by which a recorder's clock was set, and says so") {
  const TemporaryFolder folder;
  const test::Log log;
  const auto entity = participant_called("replay");
  {
    recording::Writer writer(folder / "a.mcap");
    recording::RecordedTypes types(writer);
    const auto channel =
        types.add_channel("corner", "survey::Corner", describe(idl::type_support<survey::Corner>()),
                          {{"type", "survey::Corner"}, {"systems", "uav-1"}});
    const Bytes value = idl::encode_message(survey::Corner{1, 2});
    constexpr std::uint64_t k2026 = 1'780'000'000 * kNanoseconds;
    for (const std::uint64_t time :
         {std::uint64_t{5 * kNanoseconds}, k2026, k2026 + 3600 * kNanoseconds})
      writer.write({channel, 1, time, time, value});
  }
  const recording::Reader reader(folder / "a.mcap");
  recording::Player player(*entity, reader, {});
  std::vector<Duration> pauses;
  CHECK(player.play([&](Duration pause) { return pauses.push_back(pause), false; }) == 3);
  REQUIRE(pauses.size() == 3);
  CHECK(pauses[1] == Duration::zero());
  CHECK((pauses[2] > 3590s && pauses[2] <= 3600s));
  CHECK_THAT(log.text(), Catch::Contains("nothing was recorded for 49444"));
}
