#include <atomic>
#include <catch2/catch.hpp>
#include <condition_variable>
#include <future>
#include <mutex>

#include "entity/entity_access.hpp"
#include "rpc/client/remote_channel.hpp"
#include "test/faults/exposed_service.hpp"
#include "test/faults/messages.hpp"
#include "test/faults/processes.hpp"
#include "unseen_peer.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;
namespace wire = rpc::wire;

namespace {

constexpr std::int32_t kEndless = 1 << 30;

/// Answers echo() when it is told to.
class HeldEcho : public EchoService {
 public:
  std::string echo(const std::string& text) override {
    ++inside;
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return open_; });
    --inside;
    return text;
  }
  void release() {
    std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
};

Bytes session_ended(const wire::RequestId& id) {
  Bytes message;
  wire::begin_reply(message, id, wire::RemoteException::UnknownException, wire::kOpen);
  wire::append_default_branch(message);
  wire::append_trailer(message, wire::ReplyTrailer{ErrorCode::Disconnected, "it has ended"});
  return message;
}

/// A provider, its client, and a rogue that hears the client's requests and writes to its reader.
struct Stage {
  Stage()
      : server(entity_with_lease("server", Pairing::get().server, 1000ms)),
        client(entity_with_lease("client", Pairing::get().client, 1000ms)),
        service(*server, echo),
        channel(connect()),
        proxy(channel, 10min),
        rogue(entity_with_lease("rogue", Pairing::get().client, 1000ms)),
        ear(EntityAccess::participant(*rogue), service.address()) {
    REQUIRE(eventually([&] { return ear.matched(); }));
    // What the ear hears first may have been said before it was there.
    REQUIRE(eventually([&] {
      proxy.label();
      return ear.client() != Guid{};
    }));
    mouth =
        std::make_unique<Mouth>(EntityAccess::participant(*rogue), service.address(), ear.client());
    // What is written before the other side has found the writer may be lost.
    REQUIRE(eventually([&] {
      mouth->say(session_ended({Guid::random(), 0}));
      return eventually([&] { return channel->forged() > 0; }, 200ms);
    }));
    REQUIRE(mouth->heard());
    forged_before = channel->forged();
  }
  ~Stage() { echo->release(); }

  bool refused(std::uint64_t count) const {
    return eventually([&] { return channel->forged() >= forged_before + count; });
  }

  std::shared_ptr<rpc::RemoteChannel> connect() {
    LouderEcho::Proxy any = client->connect<LouderEcho>({.provider = service.id(), .timeout = 20s});
    for (const auto& known : client->broker().all()) {
      if (known->provider != service.id().bytes) continue;
      return std::dynamic_pointer_cast<rpc::RemoteChannel>(
          client->connector().open_provider(*known, "", 20s));
    }
    return nullptr;
  }

  std::shared_ptr<HeldEcho> echo = std::make_shared<HeldEcho>();
  std::unique_ptr<Entity> server;
  std::unique_ptr<Entity> client;
  ExposedService service;
  std::shared_ptr<rpc::RemoteChannel> channel;
  LouderEcho::Proxy proxy;
  // After the channel: it hears no request of the connection that only found the service, and whose
  // reply reader is gone by now.
  std::unique_ptr<Entity> rogue;
  Ear ear;
  std::unique_ptr<Mouth> mouth;
  std::uint64_t forged_before = 0;
};

}  // namespace

TEST_CASE_METHOD(Stage,
                 "only the provider answers a call: a forged result is refused and counted") {
  auto call = proxy.async_echo("true");
  REQUIRE(eventually([&] { return echo->inside == 1; }));
  const auto request = ear.await_request(LouderEcho::interface_info(), "echo");
  mouth->say(good_reply(request));
  REQUIRE(refused(1));
  CHECK_FALSE(call.ready());
  echo->release();
  CHECK(call.get() == "true");
}

TEST_CASE_METHOD(Stage, "a forged end of a stream does not end it") {
  auto numbers = proxy.count_up(kEndless, -1);
  REQUIRE(numbers.next() == 0);
  const auto request = ear.await_request(LouderEcho::interface_info(), "count_up");
  constexpr std::uint64_t kEnds = 32;
  for (std::uint64_t position = 0; position < kEnds; ++position) {
    Bytes end = count_up_reply(request, 0);
    wire::append_trailer(end, wire::ReplyTrailer{{}, {}, wire::StreamPart::End, position});
    mouth->say(end);
  }
  REQUIRE(refused(kEnds));
  for (int i = 1; i < 50; ++i) CHECK(numbers.next() == i);
}

TEST_CASE_METHOD(Stage, "a forged dismissal does not end a connection") {
  auto call = proxy.async_echo("x");
  const auto request = ear.await_request(LouderEcho::interface_info(), "echo");
  mouth->say(session_ended({ear.client(), 0}));
  mouth->say(session_ended(request.id));
  REQUIRE(refused(2));
  CHECK(channel->connected());
  echo->release();
  CHECK(call.get() == "x");
}

TEST_CASE_METHOD(Stage, "who listens in on a connection, and leaves, does not end it") {
  {
    Ear second(EntityAccess::participant(*rogue), service.address());
    dds::Qos qos;
    qos.partitions = {ear.client().hex()};
    const auto replies =
        EntityAccess::participant(*rogue).create_reader(calls::reply_topic(service.address()), qos);
    REQUIRE(eventually([&] { return second.matched() && replies->matched_writers().size() == 2; }));
  }
  for (int i = 0; i < 100; ++i) CHECK(proxy.label() == "echo");
  CHECK(channel->connected());
  CHECK(service.counters().unconnected == 0);
}

TEST_CASE_METHOD(Stage, "a request in another client's name ends none of that client's calls") {
  dds::Qos qos;
  qos.partitions = {service.id().hex()};
  const auto writer =
      EntityAccess::participant(*rogue).create_writer(calls::request_topic(service.address()), qos);
  REQUIRE(eventually([&] { return !writer->matched_readers().empty(); }));
  // What is written before the other side has found the writer may be lost.
  REQUIRE(eventually([&] {
    writer->write(unknown_operation(writer->guid()));
    return eventually([&] { return service.counters().refused > 0; }, 200ms);
  }));
  auto call = proxy.async_echo("x");
  const auto request = ear.await_request(LouderEcho::interface_info(), "echo");
  const auto before = service.counters();

  Bytes broken;
  wire::begin_request(broken, request.id, request.operation);
  writer->write(broken);
  Bytes unknown;
  wire::begin_request(unknown, request.id, 0xDEADBEEF);
  wire::append_default_branch(unknown);
  writer->write(unknown);
  CHECK(eventually([&] { return service.counters().malformed == before.malformed + 2; }));
  CHECK(service.counters().refused == before.refused);
  echo->release();
  CHECK(call.get() == "x");
}

TEST_CASE("a forged refusal of `open` does not keep a client from its provider") {
  const auto server = entity_with_lease("server", Pairing::get().server, 1000ms);
  const auto client = entity_with_lease("client", Pairing::get().client, 1000ms);
  const auto rogue = entity_with_lease("rogue", Pairing::get().client, 1000ms);
  const calls::Address address{"test/LouderEcho", server->broker().new_provider()};
  Ear provider(EntityAccess::participant(*server), address);
  Ear ear(EntityAccess::participant(*rogue), address);
  const auto registration = server->broker().add_service(describe_echo(address.provider, "server"));
  auto connecting = std::async(std::launch::async, [&] {
    return client->connect<LouderEcho>({.provider = address.provider, .timeout = 60s});
  });
  REQUIRE(eventually([&] { return ear.client() != Guid{} && provider.client() != Guid{}; }));

  Mouth forger(EntityAccess::participant(*rogue), address, ear.client());
  Bytes refusal;
  wire::begin_reply(refusal, {ear.client(), 0}, wire::RemoteException::InvalidArgument,
                    wire::kOpen);
  wire::append_default_branch(refusal);
  wire::append_trailer(refusal, wire::ReplyTrailer{ErrorCode::InvalidArgument, "forged"});
  for (int i = 0; i < 20; ++i) {  // the first ones may be lost
    forger.say(refusal);
    REQUIRE(forger.heard());
  }

  Mouth true_one(EntityAccess::participant(*server), address, provider.client());
  Bytes opened;
  wire::begin_reply(opened, {provider.client(), 0}, wire::RemoteException::Ok, wire::kOpen);
  wire::append_default_branch(opened);
  CHECK(eventually([&] {
    true_one.say(opened);
    return connecting.wait_for(20ms) == std::future_status::ready;
  }));
  CHECK_NOTHROW(connecting.get());
}
