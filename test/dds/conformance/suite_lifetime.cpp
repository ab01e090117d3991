#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "wire.hpp"

using namespace skein;
using namespace skein::dds;
using namespace skein::dds::conformance;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

/// Writes one number after the other until it goes.
class SteadyWriter {
 public:
  SteadyWriter(Participant& participant, const Topic& topic)
      : outbox_(participant, topic, depth_one()), thread_([this] { run(); }) {}
  ~SteadyWriter() {
    stopping_ = true;
    thread_.join();
  }
  Outbox& outbox() { return outbox_; }

 private:
  // Nobody waits for anybody: what is lost here is not the question.
  static Qos depth_one() {
    Qos qos;
    qos.history_depth = 1;
    return qos;
  }
  void run() {
    for (std::uint32_t i = 0; !stopping_; ++i) {
      outbox_.writer().write(make_number(i));
      std::this_thread::sleep_for(100us);
    }
  }
  Outbox outbox_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace

TEST_CASE_METHOD(Wire, "readers come and go while samples flow") {
  SteadyWriter stream(*writing, keyless());
  for (int round = 0; round < 15; ++round) {
    Inbox inbox(*reading, keyless(), keep_all());
    REQUIRE(eventually([&] { return inbox.count() > 2; }));
  }
}

TEST_CASE_METHOD(Wire, "no listener runs after its reader or writer is destroyed") {
  SteadyWriter stream(*writing, keyless());
  std::atomic<int> late{0};
  for (int round = 0; round < 15; ++round) {
    auto ended = std::make_shared<std::atomic<bool>>(false);
    auto seen = std::make_shared<std::atomic<int>>(0);
    const auto note = [&late, ended, seen] {
      if (*ended) ++late;
      ++*seen;
    };
    ReaderListener listener;
    listener.on_data = [note](Reader& reader) {
      reader.take([](const Sample&) {});
      note();
    };
    listener.on_matched = [note](const Guid&, bool) { note(); };
    auto reader = reading->create_reader(keyless(), keep_all(), listener);
    auto writer =
        reading->create_writer(keyless(), keep_all(), {[note](const Guid&, bool) { note(); }});
    REQUIRE(eventually([&] { return *seen > 3; }));
    writer.reset();
    reader.reset();
    *ended = true;
  }
  CHECK(late == 0);
}

TEST_CASE_METHOD(Wire, "writers come and go while their reader reads") {
  Inbox inbox(*reading, keyless(), keep_all());
  for (int round = 0; round < 15; ++round) {
    const std::size_t before = inbox.count();
    SteadyWriter stream(*writing, keyless());
    REQUIRE(eventually([&] { return inbox.count() > before + 2; }));
  }
  CHECK(eventually([&] { return inbox.reader().matched_writers().empty(); }));
}

TEST_CASE_METHOD(Wire, "participants come and go while others talk") {
  SteadyWriter stream(*writing, keyless());
  Inbox inbox(*reading, keyless(), keep_all());
  for (int round = 0; round < 4; ++round) {
    const auto guest =
        make_participant(round % 2 == 0 ? kPairing.reading : kPairing.writing, domain);
    Inbox guest_inbox(*guest, keyless(), keep_all());
    REQUIRE(eventually([&] { return guest_inbox.count() > 2; }));
  }
  const std::size_t before = inbox.count();
  CHECK(eventually([&] { return inbox.count() > before; }));
}

TEST_CASE_METHOD(Wire, "endpoints are made and destroyed by several threads at once") {
  std::vector<std::thread> threads;
  std::atomic<int> delivered{0};
  for (int number = 0; number < 3; ++number) {
    threads.emplace_back([&, number] {
      const Topic topic = keyless("parallel_" + std::to_string(number));
      for (int round = 0; round < 4; ++round) {
        Outbox outbox(*writing, topic, keep_all());
        Inbox inbox(*reading, topic, keep_all());
        if (!matched(outbox, inbox)) return;
        // Cyclone DDS reports a match a moment before it delivers: a first sample can come too
        // early.
        const auto write_and_look = [&] {
          outbox.writer().write(make_number(1));
          return inbox.count() > 0;
        };
        if (eventually(write_and_look)) ++delivered;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(delivered == 12);
}

TEST_CASE_METHOD(Wire, "samples that nobody took are given back with the reader") {
  Outbox outbox(*writing, keyed(), keep_all());
  auto reader = reading->create_reader(keyed(), keep_all());
  REQUIRE(eventually([&] { return !reader->matched_writers().empty(); }));
  REQUIRE(eventually([&] { return !outbox.writer().matched_readers().empty(); }));
  for (std::uint8_t i = 0; i < 20; ++i) outbox.writer().write(make_sample(5000, i), make_key(i));
  REQUIRE(outbox.writer().wait_for_acknowledgments(10s));
  CHECK_NOTHROW(reader.reset());  // what would leak, the sanitizer run tells
}
