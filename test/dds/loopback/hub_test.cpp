#include <unistd.h>

#include <catch2/catch.hpp>
#include <future>

#include "skein/loopback.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/threads.hpp"

using namespace skein;
using namespace skein::dds;
using namespace std::chrono_literals;

namespace {

const Topic kTopic{"counts", "test::Count", false};
const std::vector<std::byte> kSample{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};

/// A writer whose only room is taken by a sample for a paused reader.
struct Full {
  Full() {
    ParticipantOptions options;
    options.lease = 10min;
    one = network.vendor()->create_participant(options);
    two = network.vendor()->create_participant(options);
    Qos qos;
    qos.max_samples = 1;
    qos.max_blocking = 1min;
    writer = one->create_writer(kTopic, qos);
    reader = two->create_reader(kTopic, qos);
    network.pause(two->guid());
    writer->write(kSample);
  }
  /// Runs `call` on a thread, and returns when that sleeps.
  template <class Call>
  static auto start(Call call) {
    std::promise<pid_t> thread;
    auto result = std::async(std::launch::async, [&thread, call] {
      thread.set_value(::gettid());
      return call();
    });
    const pid_t started = thread.get_future().get();
    REQUIRE(test::eventually([&] { return test::is_asleep(started); }));
    return result;
  }
  void make_room() {
    SECTION("when the reader gets the sample") { network.resume(two->guid()); }
    SECTION("when the reader goes") { reader.reset(); }
  }

  SystemClock clock;
  LoopbackNetwork network{clock};
  std::unique_ptr<Participant> one;
  std::unique_ptr<Participant> two;
  std::unique_ptr<Writer> writer;
  std::unique_ptr<Reader> reader;
};

}  // namespace

TEST_CASE_METHOD(Full, "a write that waits for room goes on") {
  auto written = start([this] { writer->write(kSample); });
  make_room();
  REQUIRE(written.wait_for(test::kPatience) == std::future_status::ready);
  CHECK_NOTHROW(written.get());
}

TEST_CASE_METHOD(Full, "a wait for acknowledgments ends") {
  auto acknowledged = start([this] { return writer->wait_for_acknowledgments(1min); });
  make_room();
  REQUIRE(acknowledged.wait_for(test::kPatience) == std::future_status::ready);
  CHECK(acknowledged.get());
}
