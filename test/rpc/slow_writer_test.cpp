#include <atomic>
#include <catch2/catch.hpp>
#include <condition_variable>
#include <future>
#include <mutex>

#include "call_port/dds_call_port.hpp"
#include "rpc/client/remote_channel.hpp"
#include "rpc/server/remote_server.hpp"
#include "rpc/server/sessions.hpp"
#include "rpc/service/call_journal.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/loopback.hpp"
#include "test/connector/echo_service.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;

namespace {

/// How the writers of a SlowParticipant, or the senders of a SlowPort, fare.
class Valve {
 public:
  enum class Mode { Open, Holding, HoldingFirst, Full };

  void set(Mode mode) {
    std::lock_guard lock(mutex_);
    mode_ = mode;
    changed_.notify_all();
  }

  /// Inside write(): waits while the valve holds; throws where there is no room in time.
  void pass(Duration left = Duration::max()) {
    std::unique_lock lock(mutex_);
    const bool first = inside_++ == 0;
    changed_.wait(
        lock, [&] { return mode_ != Mode::Holding && !(mode_ == Mode::HoldingFirst && first); });
    --inside_;
    ++passed_;
    if (mode_ != Mode::Full) return;
    ++refused_;
    if (!changed_.wait_for(lock, std::min<Duration>(a_try.load(), left),
                           [&] { return mode_ != Mode::Full; }))
      throw Overloaded("no room");
  }
  bool full() const {
    std::lock_guard lock(mutex_);
    return mode_ == Mode::Full;
  }
  int inside() const {
    std::lock_guard lock(mutex_);
    return inside_;
  }
  int passed() const {
    std::lock_guard lock(mutex_);
    return passed_;
  }
  int refused() const {
    std::lock_guard lock(mutex_);
    return refused_;
  }

  std::atomic<int> writers{0};  // that have not been destroyed
  std::atomic<std::chrono::milliseconds> a_try{calls::kPatience};

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Mode mode_ = Mode::Open;
  int inside_ = 0;
  int passed_ = 0;
  int refused_ = 0;
};

class SlowWriter final : public dds::Writer {
 public:
  SlowWriter(std::unique_ptr<dds::Writer> writer, Valve& valve)
      : writer_(std::move(writer)), valve_(valve) {
    ++valve_.writers;
  }
  ~SlowWriter() override {
    writer_.reset();
    --valve_.writers;
  }
  void write(std::span<const std::byte> cdr, const dds::KeyHash& key) override {
    valve_.pass();
    writer_->write(cdr, key);
  }
  void dispose(const dds::KeyHash& key) override { writer_->dispose(key); }
  bool wait_for_acknowledgments(std::chrono::milliseconds timeout) override {
    return writer_->wait_for_acknowledgments(timeout);
  }
  Guid guid() const override { return writer_->guid(); }
  std::vector<Guid> matched_readers() const override { return writer_->matched_readers(); }

 private:
  std::unique_ptr<dds::Writer> writer_;
  Valve& valve_;
};

/// A participant whose writers go through a valve.
class SlowParticipant final : public dds::Participant {
 public:
  explicit SlowParticipant(dds::Vendor& vendor) : participant_(vendor.create_participant({})) {}

  std::unique_ptr<dds::Writer> create_writer(const dds::Topic& topic, const dds::Qos& qos,
                                             dds::WriterListener listener) override {
    return std::make_unique<SlowWriter>(
        participant_->create_writer(topic, qos, std::move(listener)), valve);
  }
  std::unique_ptr<dds::Reader> create_reader(const dds::Topic& topic, const dds::Qos& qos,
                                             dds::ReaderListener listener) override {
    return participant_->create_reader(topic, qos, std::move(listener));
  }
  Guid guid() const override { return participant_->guid(); }

  Valve valve;

 private:
  std::unique_ptr<dds::Participant> participant_;
};

class SlowSender final : public calls::Sender {
 public:
  SlowSender(std::unique_ptr<calls::Sender> sender, Valve& valve)
      : sender_(std::move(sender)), valve_(valve) {
    ++valve_.writers;
  }
  ~SlowSender() override {
    sender_.reset();
    --valve_.writers;
  }
  void send(std::span<const std::byte> message, const std::function<Duration()>& left) override {
    valve_.pass(left ? left() : Duration::max());
    sender_->send(message);
  }
  bool send_lending(std::span<const std::byte>, const std::shared_ptr<LoanMemory>&,
                    std::size_t) override {
    return false;
  }
  bool await_taken(std::chrono::milliseconds timeout) override {
    return !valve_.full() && sender_->await_taken(timeout);
  }
  Guid identity() const override { return sender_->identity(); }

 private:
  std::unique_ptr<calls::Sender> sender_;
  Valve& valve_;
};

/// A port whose senders go through a valve.
class SlowPort final : public calls::ProviderPort, public calls::ClientPort {
 public:
  explicit SlowPort(dds::Vendor& vendor) : participant_(vendor.create_participant({})) {}

  std::unique_ptr<calls::Receiver> receive_requests(const calls::Address& address, bool foreign,
                                                    calls::Listener listener) override {
    return port_.receive_requests(address, foreign, std::move(listener));
  }
  std::unique_ptr<calls::Sender> send_replies(const calls::Address& address, const Guid& client,
                                              calls::PeerListener on_peer) override {
    return slow(port_.send_replies(address, client, std::move(on_peer)));
  }
  std::unique_ptr<calls::Sender> send_requests(const calls::Address& address,
                                               calls::PeerListener on_peer,
                                               std::function<void()> on_full) override {
    return slow(port_.send_requests(address, std::move(on_peer), std::move(on_full)));
  }
  std::unique_ptr<calls::Receiver> receive_replies(const calls::Address& address,
                                                   const Guid& client,
                                                   calls::Listener listener) override {
    return port_.receive_replies(address, client, std::move(listener));
  }

  Valve valve;

 private:
  std::unique_ptr<calls::Sender> slow(std::unique_ptr<calls::Sender> sender) {
    return std::make_unique<SlowSender>(std::move(sender), valve);
  }

  const std::unique_ptr<dds::Participant> participant_;
  calls::DdsCallPort port_{*participant_};
};

/// A server and a client of it, each with a valve of its own.
struct Pair {
  Pair() {
    rpc::RemoteChannel::Options options;
    options.peer = "the server";
    options.timeout = 20s;
    channel = rpc::RemoteChannel::open(calling, control, continuations, clock,
                                       {"test/LouderEcho", service->id()}, options);
  }
  ~Pair() {
    serving.valve.set(Valve::Mode::Open);
    calling.valve.set(Valve::Mode::Open);
  }

  LouderEcho::Proxy echo(Duration deadline = 10min) { return LouderEcho::Proxy(channel, deadline); }

  const std::shared_ptr<SystemClock> clock = std::make_shared<SystemClock>();
  dds::LoopbackNetwork network{*clock};
  const std::shared_ptr<dds::Vendor> vendor = network.vendor();
  SlowPort serving{*vendor};
  SlowPort calling{*vendor};
  const std::shared_ptr<ThreadExecutor> continuations =
      std::make_shared<ThreadExecutor>("continue");
  ThreadExecutor control{"control"};
  ThreadExecutor executor{"echo"};
  const std::shared_ptr<EchoService> implementation = std::make_shared<EchoService>();
  const std::shared_ptr<rpc::Service> service =
      std::make_shared<rpc::Service>(std::make_shared<LouderEcho::Skeleton>(implementation),
                                     executor, *clock, rpc::Service::Options{});
  std::unique_ptr<rpc::RemoteServer> server = std::make_unique<rpc::RemoteServer>(
      serving, control, *clock, service, rpc::RemoteServer::Options{});
  std::shared_ptr<rpc::RemoteChannel> channel;
};

const OperationInfo& operation_named(std::string_view name) {
  for (const OperationInfo& operation : LouderEcho::interface_info().operations) {
    if (operation.name == name) return operation;
  }
  throw std::runtime_error("no such operation");
}

/// Runs what must not end while a thread is inside a writer, and lets that thread go on then.
template <class End>
void check_that_it_waits(Valve& valve, End end) {
  REQUIRE(eventually([&] { return valve.inside() > 0; }));
  int left_behind = -1;
  auto ending = std::async(std::launch::async, [&] {
    end();
    left_behind = valve.writers;
  });
  // What does not wait has ended by then; what waits is not hurt by it.
  CHECK(ending.wait_for(200ms) == std::future_status::timeout);
  valve.set(Valve::Mode::Open);
  ending.get();
  CHECK(left_behind == 0);
}

}  // namespace

TEST_CASE_METHOD(Pair, "a server that ends waits for who is inside one of its writers") {
  serving.valve.set(Valve::Mode::Holding);
  auto call = echo().async_echo("x");
  check_that_it_waits(serving.valve, [&] { server.reset(); });
}

TEST_CASE_METHOD(Pair, "a connection that ends waits for who is inside its writer") {
  calling.valve.set(Valve::Mode::Holding);
  auto caller = std::async(std::launch::async, [&] { CHECK_THROWS_AS(echo().echo("x"), Error); });
  check_that_it_waits(calling.valve, [&] { channel->disconnect(); });
}

TEST_CASE("a journal that ends waits for who is inside its writer") {
  SystemClock clock;
  dds::LoopbackNetwork network(clock);
  const auto vendor = network.vendor();
  SlowParticipant participant(*vendor);
  ThreadExecutor control("control");
  rpc::CallJournal journal(participant, clock, control, "uav-1/test");
  introspection::Reader<introspection::CallEvents> reader(
      participant, introspection::kTopic<introspection::CallEvents>,
      [](const introspection::CallEvents&) {});
  REQUIRE(eventually([&] { return journal.on(); }));
  participant.valve.set(Valve::Mode::Holding);
  journal.note(introspection::CallStep::Sent, Guid::random(), 1, "test::Echo",
               LouderEcho::interface_info().operations[0]);
  check_that_it_waits(participant.valve, [&] { journal.close(); });
}

TEST_CASE_METHOD(Pair, "a call that has ended before it is sent is not sent") {
  const OperationInfo& operation = operation_named("echo");
  std::string out;
  const auto call = std::make_shared<PendingCall>(operation, &out, Instant::max(), false);
  call->cancel();
  const std::string text = "x";
  const ::test::Echo_echo_In in{Argument<std::string>::borrow(text)};
  channel->start(call, &in);
  CHECK(echo().echo("y") == "y");
  CHECK(implementation->calls == 1);
}

TEST_CASE_METHOD(Pair, "a stream that is cancelled while its request is sent holds up no other") {
  const OperationInfo& operation = operation_named("count_up");
  const auto stream = std::make_shared<PendingStream>(operation, Instant::max());
  calling.valve.set(Valve::Mode::HoldingFirst);
  auto caller = std::async(std::launch::async, [&] {
    const ::test::Echo_count_up_In in{1 << 30, -1};
    channel->start(stream, &in);
  });
  REQUIRE(eventually([&] { return calling.valve.inside() == 1; }));
  const auto before = calling.valve.passed();
  stream->cancel();
  REQUIRE(eventually([&] { return calling.valve.passed() > before; }));  // its end is told first
  calling.valve.set(Valve::Mode::Open);
  caller.get();
  CHECK(echo(10s).echo("y") == "y");
}

TEST_CASE_METHOD(
    Pair, "answers for which there is no room arrive once there is some, within their deadlines") {
  serving.valve.set(Valve::Mode::Full);
  std::vector<Call<std::string>> calls;
  for (int i = 0; i < 50; ++i) calls.push_back(echo().async_echo(std::to_string(i)));
  auto numbers = echo().count_up(5, -1);
  REQUIRE(eventually([&] { return implementation->stream_ended.load(); }));
  REQUIRE(serving.valve.refused() > 0);
  serving.valve.set(Valve::Mode::Open);
  for (int i = 0; i < 50; ++i) {
    REQUIRE(eventually([&] { return calls[static_cast<std::size_t>(i)].ready(); }));
    CHECK(calls[static_cast<std::size_t>(i)].get() == std::to_string(i));
  }
  for (int i = 0; i < 5; ++i) CHECK(numbers.next() == i);
  CHECK(numbers.next() == std::nullopt);
  CHECK(server->counters().lost == 0);
  CHECK(echo().echo("again") == "again");
}

TEST_CASE_METHOD(
    Pair, "a caller that waits for its answer waits for room, too; one that does not is told") {
  calling.valve.set(Valve::Mode::Full);
  auto asked = echo().async_echo("y");
  CHECK_THROWS_AS(asked.get(), Overloaded);
  auto caller = std::async(std::launch::async, [&] { return echo().echo("x"); });
  REQUIRE(eventually([&] { return calling.valve.refused() > 3; }));
  calling.valve.set(Valve::Mode::Open);
  CHECK(caller.get() == "x");
  CHECK(implementation->calls == 1);
}

TEST_CASE_METHOD(
    Pair, "a call for which there is no room until its deadline is refused, and not executed") {
  calling.valve.set(Valve::Mode::Full);
  CHECK_THROWS_AS(echo(300ms).echo("x"), Overloaded);
  CHECK(calling.valve.refused() > 1);
  calling.valve.set(Valve::Mode::Open);
  CHECK(echo().echo("y") == "y");
  CHECK(implementation->calls == 1);
}

TEST_CASE_METHOD(Pair,
                 "a call whose message is taken slowly is inside for no longer than its limit") {
  calling.valve.set(Valve::Mode::Full);
  calling.valve.a_try = 10s;
  CHECK_THROWS_AS(echo(1s).echo("x"), Overloaded);
  CHECK(calling.valve.refused() <= 2);
}

TEST_CASE_METHOD(
    Pair, "an answer for which there is no room until its deadline is given up, and counted") {
  serving.valve.set(Valve::Mode::Full);
  CHECK_THROWS_AS(echo(200ms).echo("x"), TimedOut);
  CHECK(eventually([&] { return server->counters().lost == 1; }));
  serving.valve.set(Valve::Mode::Open);
  CHECK(echo().echo("y") == "y");
}

TEST_CASE_METHOD(
    Pair, "what waits for room is bounded: a client may have half of it, and the rest is counted") {
  serving.valve.set(Valve::Mode::Full);
  constexpr std::size_t kSize = 16 << 20;
  constexpr std::size_t kFit = rpc::ReplyContext::kMaxUnsent / 2 / kSize;
  const std::vector<std::uint8_t> content(kSize);
  std::vector<Call<std::vector<std::uint8_t>>> calls;
  for (std::size_t i = 0; i <= kFit; ++i) calls.push_back(echo().async_echo_octets(content));
  CHECK(eventually([&] { return server->counters().lost == 1; }));
  CHECK(implementation->calls == kFit + 1);
}
