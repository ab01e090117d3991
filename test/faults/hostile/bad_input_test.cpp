#include <atomic>
#include <catch2/catch.hpp>
#include <mutex>
#include <random>
#include <thread>

#include "call_port/dds_call_port.hpp"
#include "entity/entity_access.hpp"
#include "rpc/client/remote_channel.hpp"
#include "skein/detail/type_support.hpp"
#include "test/faults/exposed_service.hpp"
#include "test/faults/messages.hpp"
#include "test/faults/processes.hpp"
#include "test/tools/seed.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using brokerless_discovery::Refusal;
using ::test::LouderEcho;

namespace {

/// A provider, a good client that calls without pause, and a stranger who writes what he likes.
class Attacked {
 public:
  Attacked()
      : server(entity_with_lease("server", Pairing::get().server, 1000ms)),
        client(entity_with_lease("client", Pairing::get().client, 1000ms)),
        stranger(entity_with_lease("stranger", Pairing::get().client, 1000ms)),
        service(*server, std::make_shared<EchoService>()),
        echo_(client->connect<LouderEcho>({.timeout = 20s})) {
    caller_ = std::thread([this] { call(); });
  }
  ~Attacked() {
    stop_ = true;
    caller_.join();
  }

  /// Whether the good client's calls go on, and none has failed.
  bool unharmed() {
    const int before = good_;
    return eventually([&] { return good_ > before + 3; }) && bad_ == 0;
  }

  std::unique_ptr<Entity> server;
  std::unique_ptr<Entity> client;
  std::unique_ptr<Entity> stranger;
  ExposedService service;

 private:
  void call() {
    while (!stop_) {
      const std::string text = std::to_string(good_);
      try {
        ++(echo_.within(20s).echo(text) == text ? good_ : bad_);
      } catch (const Error&) {
        ++bad_;
      }
    }
  }

  LouderEcho::Proxy echo_;
  std::atomic<int> good_{0};
  std::atomic<int> bad_{0};
  std::atomic<bool> stop_{false};
  std::thread caller_;
};

std::unique_ptr<dds::Writer> matched_writer(Entity& entity, const dds::Topic& topic,
                                            const dds::Qos& qos) {
  auto writer = EntityAccess::participant(entity).create_writer(topic, qos);
  REQUIRE(eventually([&] { return !writer->matched_readers().empty(); }));
  return writer;
}

/// A stranger's writer of requests that the service hears: what it writes before the other side has
/// found it may be lost.
std::unique_ptr<dds::Writer> writer_to(Attacked& attacked) {
  dds::Qos qos;
  qos.partitions = {attacked.service.id().hex()};
  auto writer =
      matched_writer(*attacked.stranger, calls::request_topic(attacked.service.address()), qos);
  REQUIRE(eventually([&] {
    writer->write(unknown_operation(writer->guid()));
    return eventually([&] { return attacked.service.counters().refused > 0; }, 200ms);
  }));
  return writer;
}

std::mt19937_64 seeded_random() { return std::mt19937_64(seed_of_this_run()); }

}  // namespace

TEST_CASE_METHOD(Attacked,
                 "malformed requests are counted and dropped, and a good client does not notice") {
  const auto writer = writer_to(*this);
  auto random = seeded_random();
  const auto messages = bad_requests(writer->guid(), random);
  const auto looked_at = [&] {
    const auto counters = service.counters();
    return counters.malformed + counters.refused + counters.unconnected;
  };
  const auto before = looked_at();
  for (const Message& message : messages) writer->write(message.bytes);
  CHECK(eventually([&] { return looked_at() >= before + messages.size(); }));
  CHECK(service.counters().malformed > 0);
  CHECK(service.counters().refused > 0);
  CHECK(unharmed());
  CHECK(eventually([&] { return service.counters().active <= 1; }));
  CHECK(service.counters().clients == 1);
}

TEST_CASE_METHOD(Attacked, "nobody speaks in another client's name") {
  const auto writer = writer_to(*this);
  const auto before = service.counters();
  for (const std::uint32_t operation : {rpc::wire::kOpen, rpc::wire::kCancel, rpc::wire::kCredit}) {
    Bytes message;
    rpc::wire::begin_request(message, {Guid::random(), 0}, operation);
    rpc::wire::append_default_branch(message);
    rpc::wire::append_trailer(message, rpc::wire::RequestTrailer{1s, 1, {}, ""});
    writer->write(message);
  }
  CHECK(eventually([&] { return service.counters().malformed == before.malformed + 3; }));
  CHECK(service.counters().clients == 1);
  CHECK(unharmed());
}

TEST_CASE_METHOD(
    Attacked,
    "malformed service descriptions are counted and dropped, and every table stays as it is") {
  dds::Qos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  qos.liveliness_lease = 1000ms;
  qos.partitions = {""};
  const auto writer = matched_writer(
      *stranger, {"skein/services", "skein::discovery::ServiceDescription", true}, qos);
  REQUIRE(eventually([&] { return writer->matched_readers().size() == 3; }));
  const std::vector<Entity*> all{server.get(), client.get(), stranger.get()};
  for (Entity* entity : all)
    REQUIRE(eventually([&] { return entity->broker().knows(service.id()); }));
  auto random = seeded_random();

  Bytes good{std::span<const std::byte>(idl::kEncapsulation)};
  auto description = describe_echo(stranger->broker().new_provider(), "stranger");
  description.system = "uav-1";
  idl::type_support<brokerless_discovery::ServiceDescription>().encode(&description, good);
  const auto messages = broken_copies(good, random);
  for (const Message& message : messages) {
    writer->write(message.bytes, stranger->broker().new_provider());
  }

  for (Entity* entity : all) {
    const auto& broker = entity->broker();
    CHECK(eventually([&] {
      return broker.refused(Refusal::Malformed) + broker.refused(Refusal::Oversized) ==
             messages.size();
    }));
    CHECK(entity->broker().all().size() == 1);
  }
  CHECK(unharmed());
  CHECK(client->connect<LouderEcho>({.timeout = 20s}).echo("x") == "x");
}

namespace {

/// A provider that answers `open` as it should, and each call with the next of its bad replies.
class RogueServer {
 public:
  explicit RogueServer(Entity& entity) : entity_(entity), id_(entity.broker().new_provider()) {
    dds::Qos qos;
    qos.partitions = {id_.hex()};
    dds::ReaderListener listener;
    listener.on_data = [this](dds::Reader& reader) {
      reader.take([this](const dds::Sample& sample) {
        const auto head = rpc::wire::read_request_head(sample.cdr);
        worker_.post([this, head] { answer(head); });
      });
    };
    reader_ = EntityAccess::participant(entity).create_reader(calls::request_topic(address()), qos,
                                                              std::move(listener));
    registration_ = entity.broker().add_service(describe_echo(id_, "rogue"));
  }
  ~RogueServer() {
    registration_.withdraw();
    reader_.reset();
    worker_.stop();
  }

  calls::Address address() const { return {"test/LouderEcho", id_}; }
  const Guid& id() const { return id_; }

  /// What the next call gets. Set before it is made.
  void answer_with(std::function<Bytes(const rpc::wire::RequestHead&)> reply) {
    std::lock_guard lock(mutex_);
    reply_ = std::move(reply);
  }

 private:
  void answer(const rpc::wire::RequestHead& head) {
    if (!writer_) {
      dds::Qos qos;
      qos.partitions = {head.id.client.hex()};
      writer_ =
          EntityAccess::participant(entity_).create_writer(calls::reply_topic(address()), qos);
    }
    Bytes message;
    if (head.operation == rpc::wire::kOpen) {
      rpc::wire::begin_reply(message, head.id, rpc::wire::RemoteException::Ok, rpc::wire::kOpen);
      rpc::wire::append_default_branch(message);
    } else if (head.operation != rpc::wire::kCancel && head.operation != rpc::wire::kCredit) {
      std::lock_guard lock(mutex_);
      message = reply_(head);
    }
    if (!message.empty()) writer_->write(message);
  }

  Entity& entity_;
  const Guid id_;
  ThreadExecutor worker_{"rogue"};
  std::mutex mutex_;  // a sanitizer does not see that a message travels between the two threads
  std::function<Bytes(const rpc::wire::RequestHead&)> reply_;
  std::unique_ptr<dds::Writer> writer_;
  std::unique_ptr<dds::Reader> reader_;
  brokerless_discovery::Broker::Registration registration_;
};

}  // namespace

namespace {

std::shared_ptr<rpc::RemoteChannel> channel_to(const RogueServer& rogue, Entity& client) {
  REQUIRE(eventually([&] { return client.broker().knows(rogue.id()); }));
  const auto description = [&] {
    for (const auto& known : client.broker().all()) {
      if (known->provider == rogue.id().bytes) return known;
    }
    throw std::runtime_error("the rogue is not known");
  }();
  const auto channel = client.connector().open_provider(*description, "", 20s);
  const auto remote_channel = std::dynamic_pointer_cast<rpc::RemoteChannel>(channel);
  REQUIRE(remote_channel);
  return remote_channel;
}

}  // namespace

TEST_CASE_METHOD(
    Attacked,
    "a server that answers with nonsense: each call ends, with the reason, and none stays "
    "pending") {
  RogueServer rogue(*stranger);
  const auto channel = channel_to(rogue, *client);
  LouderEcho::Proxy proxy(channel, 20s);
  auto random = seeded_random();

  for (const BadReply& bad : bad_replies(random)) {
    INFO(bad.name);
    rogue.answer_with(bad.make);
    try {
      proxy.within(bad.tells_the_call ? Duration(20s) : Duration(20ms)).echo("x");
      FAIL_CHECK("the reply was taken for a good one");
    } catch (const TimedOut&) {
      CHECK_FALSE(bad.tells_the_call);
    } catch (const Internal& error) {
      CHECK(bad.tells_the_call);
      CHECK_THAT(error.what(), Catch::Contains("rogue") && Catch::Contains("echo"));
    }
    CHECK(channel->pending() == 0);
  }
  CHECK(channel->malformed() > 0);
  CHECK(channel->connected());
  CHECK(unharmed());

  rogue.answer_with([](const rpc::wire::RequestHead& head) { return good_reply(head); });
  CHECK(proxy.within(20s).echo("x") == "x");
}

TEST_CASE_METHOD(
    Attacked, "a server that sends what is no part of a stream: the stream ends, with the reason") {
  RogueServer rogue(*stranger);
  const auto channel = channel_to(rogue, *client);
  LouderEcho::Proxy proxy(channel, 20s);
  for (const BadReply& bad : bad_stream_replies()) {
    INFO(bad.name);
    rogue.answer_with(bad.make);
    auto numbers = proxy.count_up(1, -1);
    CHECK_THROWS_AS(numbers.next(), Internal);
    CHECK(channel->pending() == 0);
  }
  CHECK(unharmed());
}

TEST_CASE_METHOD(Attacked,
                 "the one reply of a server that knows no streams is a stream of one result") {
  RogueServer plain(*stranger);
  LouderEcho::Proxy proxy(channel_to(plain, *client), 20s);
  plain.answer_with([](const rpc::wire::RequestHead& head) { return count_up_reply(head, 42); });
  auto numbers = proxy.count_up(1, -1);
  CHECK(numbers.next() == 42);
  CHECK(numbers.next() == std::nullopt);
}
