#include <atomic>
#include <catch2/catch.hpp>
#include <future>
#include <map>
#include <thread>

#include "call_port/dds_call_port.hpp"
#include "rpc/server/remote_server.hpp"
#include "rpc/wire/wire.hpp"
#include "test/connector/echo_service.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;

namespace {

/// The provider's participant, played by the test: it says which requests come and who matches, on
/// whichever thread, and takes no notice of replies.
class PlayedParticipant final : public dds::Participant {
 public:
  std::unique_ptr<dds::Writer> create_writer(const dds::Topic&, const dds::Qos& qos,
                                             dds::WriterListener listener) override {
    std::lock_guard lock(mutex_);
    writers_[qos.partitions.front()] = std::move(listener);
    ++writers_made_[qos.partitions.front()];
    return std::make_unique<CountingWriter>(written_[qos.partitions.front()]);
  }
  std::unique_ptr<dds::Reader> create_reader(const dds::Topic&, const dds::Qos&,
                                             dds::ReaderListener listener) override {
    reader_ = std::move(listener);
    return std::make_unique<OneSample>();
  }
  Guid guid() const override { return {}; }

  void request(const Guid& client, const Bytes& message) {
    OneSample reader;
    reader.sample = {message, dds::InstanceState::Alive, {}, client};
    reader_.on_data(reader);
  }
  bool answers(const Guid& client) const {
    std::lock_guard lock(mutex_);
    return writers_.contains(client.hex());
  }
  /// How often its client was met by a writer of its own.
  int writers_made(const Guid& client) const {
    std::lock_guard lock(mutex_);
    const auto found = writers_made_.find(client.hex());
    return found == writers_made_.end() ? 0 : found->second;
  }
  /// How many replies were written to its client.
  int written(const Guid& client) const {
    std::lock_guard lock(mutex_);
    const auto found = written_.find(client.hex());
    return found == written_.end() ? 0 : found->second.load();
  }
  void match_request_writer(const Guid& client, bool matched = true) const {
    reader_.on_matched(client, matched);
  }
  void match(const Guid& client, bool matched) const {
    std::unique_lock lock(mutex_);
    const auto told = writers_.at(client.hex()).on_matched;
    lock.unlock();
    told(client, matched);
  }

 private:
  struct CountingWriter final : dds::Writer {
    explicit CountingWriter(std::atomic<int>& count) : count_(count) {}
    void write(std::span<const std::byte>, const dds::KeyHash&) override { ++count_; }
    void dispose(const dds::KeyHash&) override {}
    bool wait_for_acknowledgments(std::chrono::milliseconds) override { return true; }
    Guid guid() const override { return {}; }
    std::vector<Guid> matched_readers() const override { return {}; }
    std::atomic<int>& count_;
  };
  struct OneSample final : dds::Reader {
    std::size_t take(const std::function<void(const dds::Sample&)>& consumer,
                     std::size_t) override {
      consumer(sample);
      return 1;
    }
    Guid guid() const override { return {}; }
    std::vector<Guid> matched_writers() const override { return {}; }
    dds::ReceiveCounters counters() const override { return {}; }
    dds::Sample sample;
  };

  mutable std::mutex mutex_;
  std::map<std::string, dds::WriterListener> writers_;
  std::map<std::string, int> writers_made_;
  std::map<std::string, std::atomic<int>> written_;
  dds::ReaderListener reader_;
};

Bytes request(const Guid& client, std::uint64_t number, std::uint32_t operation) {
  Bytes message;
  rpc::wire::begin_request(message, {client, number}, operation);
  return message;
}

Bytes open_request(const Guid& client) {
  Bytes message = request(client, 0, rpc::wire::kOpen);
  rpc::wire::append_default_branch(message);
  rpc::wire::append_trailer(message, rpc::wire::RequestTrailer{20s});
  return message;
}

/// As a client without Skein writes it.
template <class In>
Bytes foreign_request(const Guid& client, std::uint64_t number, std::string_view name,
                      const In& in) {
  for (const OperationInfo& operation : Echo::interface_info().operations) {
    if (operation.name != name) continue;
    Bytes message = request(client, number, operation.hash);
    operation.in->encode(&in, message);
    return message;
  }
  throw std::logic_error("the interface has no such operation");
}

/// One for an hour's work.
Bytes foreign_request(const Guid& client, std::uint64_t number) {
  return foreign_request(client, number, "wait", ::test::Echo_wait_In{3'600'000});
}

Bytes oneway_request(const Guid& client, std::uint64_t number) {
  Bytes message = foreign_request(client, number, "note", ::test::Echo_note_In{"x"});
  rpc::wire::append_trailer(message, rpc::wire::RequestTrailer{1h});
  return message;
}

Bytes long_request(const Guid& client, std::uint64_t number) {
  Bytes message = foreign_request(client, number);
  rpc::wire::append_trailer(message, rpc::wire::RequestTrailer{1h});
  return message;
}

/// An echo service for clients that the test plays.
struct Provider {
  PlayedParticipant participant;
  calls::DdsCallPort port{participant};
  SystemClock clock;
  ThreadExecutor control{"control"};
  ThreadExecutor executor{"worker"};
  std::shared_ptr<EchoService> service = std::make_shared<EchoService>();
  rpc::RemoteServer server{port,
                           control,
                           clock,
                           std::make_shared<rpc::Service>(std::make_shared<Echo::Skeleton>(service),
                                                          executor, clock, rpc::Service::Options{}),
                           {.foreign_clients = true}};
};

}  // namespace

TEST_CASE("a request that comes at the moment in which its client leaves keeps nobody busy") {
  PlayedParticipant participant;
  calls::DdsCallPort port(participant);
  SystemClock clock;
  ThreadExecutor control("control");
  constexpr std::size_t kNeverFull = 1 << 24;
  ThreadExecutor executor("worker", 1, kNeverFull);
  rpc::Service::Options options;
  options.queue = kNeverFull;
  const auto service = std::make_shared<rpc::Service>(
      std::make_shared<Echo::Skeleton>(std::make_shared<EchoService>()), executor, clock, options);
  rpc::RemoteServer server(port, control, clock, service, {});
  for (int round = 0; round < 100; ++round) {
    const Guid client = Guid::random();
    participant.request(client, open_request(client));
    REQUIRE(eventually([&] { return participant.answers(client); }));
    participant.match(client, true);
    std::atomic<bool> left = false;
    std::thread sender([&] {
      for (std::uint64_t number = 1; !left; ++number)
        participant.request(client, long_request(client, number));
    });
    const bool working = eventually([&] { return server.counters().active > 0; });
    participant.match(client, false);
    const bool gone = eventually([&] { return server.counters().clients == 0; });
    left = true;
    sender.join();
    REQUIRE(working);
    REQUIRE(gone);
    REQUIRE(eventually([&] { return server.counters().active == 0; }));
  }
}

TEST_CASE_METHOD(Provider, "a client that leaves before it is admitted takes no session with it") {
  std::promise<void> idle;
  REQUIRE(control.post([until = idle.get_future().share()] { until.wait(); }));
  const Guid client = Guid::random();
  participant.request(client, open_request(client));
  participant.match_request_writer(client, false);
  const Guid next = Guid::random();
  participant.request(next, open_request(next));
  idle.set_value();
  REQUIRE(eventually([&] { return participant.answers(next); }));
  CHECK_FALSE(participant.answers(client));
  CHECK(server.counters().clients == 1);
}

TEST_CASE_METHOD(Provider,
                 "a request of a client without Skein ends when its sender leaves, others go on") {
  const Guid leaving = Guid::random();
  const Guid staying = Guid::random();
  for (const Guid& writer : {leaving, staying}) {
    participant.match_request_writer(writer);
    // Its name for itself need not be its writer's.
    participant.request(writer, foreign_request(Guid::random(), 1));
  }
  REQUIRE(server.counters().active == 2);
  participant.match_request_writer(leaving, false);
  CHECK(eventually([&] { return server.counters().active == 1; }));
  participant.match_request_writer(staying, false);
  CHECK(eventually([&] { return server.counters().active == 0; }));
}

TEST_CASE_METHOD(Provider, "oneway calls that wait when their client leaves are executed") {
  const Guid client = Guid::random();
  participant.request(client, open_request(client));
  REQUIRE(eventually([&] { return participant.answers(client); }));
  participant.match(client, true);
  std::promise<void> free;
  REQUIRE(executor.post([until = free.get_future().share()] { until.wait(); }));
  for (std::uint64_t i = 1; i <= 3; ++i) participant.request(client, oneway_request(client, i));
  REQUIRE(server.counters().active == 3);
  participant.match_request_writer(client, false);
  participant.match(client, false);
  REQUIRE(eventually([&] { return server.counters().clients == 0; }));
  free.set_value();
  CHECK(eventually([&] { return service->noted() == 3; }));
}

TEST_CASE_METHOD(Provider,
                 "a client that leaves before its reader was found keeps no session for long") {
  const Guid client = Guid::random();
  participant.request(client, open_request(client));
  REQUIRE(eventually([&] { return participant.answers(client); }));
  REQUIRE(server.counters().clients == 1);
  participant.match_request_writer(client, false);
  // Half as long as it would be waited for otherwise.
  CHECK(eventually([&] { return server.counters().clients == 0; }, 5s));
}

TEST_CASE_METHOD(
    Provider,
    "who comes back to a session that has ended is told so again and again, as it may miss it") {
  const Guid client = Guid::random();
  participant.request(client, open_request(client));
  REQUIRE(eventually([&] { return participant.answers(client); }));
  participant.match(client, true);
  participant.match(client, false);
  REQUIRE(eventually([&] { return server.counters().clients == 0; }));

  participant.match_request_writer(client);
  REQUIRE(eventually([&] { return participant.writers_made(client) == 2; }));
  const int before = participant.written(client);
  participant.match(client, true);
  CHECK(eventually([&] { return participant.written(client) >= before + 4; }));

  participant.match(client, false);
  CHECK(eventually([&] { return server.counters().clients == 0; }));
}

TEST_CASE_METHOD(
    Provider, "of the clients that have left, the one that left longest ago is forgotten first") {
  const auto come_and_go = [&](const Guid& client) {
    participant.request(client, open_request(client));
    REQUIRE(eventually([&] { return participant.answers(client); }));
    participant.match(client, true);
    participant.match(client, false);
    REQUIRE(eventually([&] { return server.counters().clients == 0; }));
  };
  Guid greatest;
  greatest.bytes.fill(0xff);
  Guid smallest;
  smallest.bytes[15] = 1;
  come_and_go(greatest);
  for (int i = 0; i < 1024; ++i) come_and_go(Guid::random());
  come_and_go(smallest);
  come_and_go(Guid::random());
  // Whoever is remembered hears, when it comes back, that its session has ended.
  participant.match_request_writer(greatest);
  participant.match_request_writer(smallest);
  CHECK(eventually([&] { return participant.writers_made(smallest) == 2; }));
  CHECK(participant.writers_made(greatest) == 1);
}
