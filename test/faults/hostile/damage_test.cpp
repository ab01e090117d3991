#include <catch2/catch.hpp>
#include <future>
#include <mutex>

#include "entity/entity_access.hpp"
#include "test/faults/exposed_service.hpp"
#include "test/faults/messages.hpp"
#include "test/faults/processes.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;
namespace wire = rpc::wire;

namespace {

struct Heard {
  wire::ReplyHead head;
  std::string text;
};

/// A client that writes its requests by hand, and so can damage them.
class HandClient {
 public:
  HandClient(dds::Participant& participant, const calls::Address& address) {
    dds::Qos qos;
    qos.partitions = {calls::partition_of(address.provider)};
    writer_ = participant.create_writer(calls::request_topic(address), qos);
    qos.partitions = {guid().hex()};
    dds::ReaderListener listener;
    listener.on_data = [this](dds::Reader& reader) {
      reader.take([this](const dds::Sample& sample) {
        if (sample.state != dds::InstanceState::Alive) return;
        const auto head = wire::read_reply_head(sample.cdr);
        const auto trailer = wire::read_reply_trailer(sample.cdr, head.result + 1);
        std::lock_guard lock(mutex_);
        answers_.push_back({head, trailer ? trailer->text : ""});
      });
    };
    reader_ = participant.create_reader(calls::reply_topic(address), qos, std::move(listener));
  }

  Guid guid() const { return writer_->guid(); }

  void open() {
    REQUIRE(eventually([&] {
      Bytes message;
      wire::begin_request(message, {guid(), 0}, wire::kOpen);
      wire::append_default_branch(message);
      wire::append_trailer(message, wire::RequestTrailer{1s, 0, {}, ""});
      writer_->write(message);
      return eventually([&] { return answer_to(0).has_value(); }, 200ms);
    }));
  }

  void write(const Bytes& message) { writer_->write(message); }

  std::optional<Heard> answer_to(std::uint64_t number) const {
    std::lock_guard lock(mutex_);
    for (const Heard& answer : answers_) {
      if (answer.head.related.number == number) return answer;
    }
    return std::nullopt;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Heard> answers_;
  std::unique_ptr<dds::Writer> writer_;
  std::unique_ptr<dds::Reader> reader_;
};

Bytes first(const Bytes& message, std::size_t size) {
  return Bytes(std::span<const std::byte>(message).first(size));
}

/// Answers each `open` in the address's partition with what it is given.
class Opener {
 public:
  using MakeAnswer = std::function<Bytes(const wire::RequestId&)>;

  Opener(dds::Participant& participant, const calls::Address& address, MakeAnswer make)
      : participant_(participant), address_(address), make_(std::move(make)) {
    dds::Qos qos;
    qos.partitions = {calls::partition_of(address.provider)};
    dds::ReaderListener listener;
    listener.on_data = [this](dds::Reader& reader) {
      reader.take([this](const dds::Sample& sample) {
        if (sample.state != dds::InstanceState::Alive) return;
        worker_.post([this, id = wire::read_request_head(sample.cdr).id] { answer(id); });
      });
    };
    reader_ = participant.create_reader(calls::request_topic(address), qos, std::move(listener));
  }
  ~Opener() {
    reader_.reset();
    worker_.stop();
  }

 private:
  void answer(const wire::RequestId& id) {
    if (!writer_) {
      dds::Qos qos;
      qos.partitions = {id.client.hex()};
      writer_ = participant_.create_writer(calls::reply_topic(address_), qos);
    }
    writer_->write(make_(id));
  }

  dds::Participant& participant_;
  const calls::Address address_;
  const MakeAnswer make_;
  ThreadExecutor worker_{"opener"};
  std::unique_ptr<dds::Writer> writer_;
  std::unique_ptr<dds::Reader> reader_;
};

Bytes answer_to_open(const wire::RequestId& id, wire::RemoteException exception) {
  Bytes message;
  wire::begin_reply(message, id, exception, 0);
  wire::append_default_branch(message);
  return message;
}

}  // namespace

TEST_CASE("a request that was damaged on its way is answered at once, with cause and remedy") {
  const auto server = entity_with_lease("server", Pairing::get().server, 1000ms);
  const auto client = entity_with_lease("client", Pairing::get().client, 1000ms);
  ExposedService service(*server, std::make_shared<EchoService>());
  HandClient hand(EntityAccess::participant(*client), service.address());
  hand.open();

  Bytes good = echo_request(hand.guid());
  wire::append_trailer(good, wire::RequestTrailer{60s, 0, {}, ""});
  constexpr std::size_t kReadableId = 4 + 24;
  std::uint64_t number = 100;
  for (std::size_t size = kReadableId; size < good.size(); ++size) {
    INFO("cut off after " << size);
    Bytes damaged = first(good, size);
    const auto low = static_cast<std::uint32_t>(++number);
    std::memcpy(damaged.data() + kReadableId - 4, &low, sizeof low);
    hand.write(damaged);
    REQUIRE(eventually([&] { return hand.answer_to(number).has_value(); }));
    const Heard answer = *hand.answer_to(number);
    CHECK(answer.head.exception == wire::RemoteException::InvalidArgument);
    CHECK_THAT(answer.text, Catch::Contains("cannot be read") && Catch::Contains("damaged"));
  }
}

TEST_CASE("who waited for `open` in vain hears of answers that could not be read") {
  const auto server = entity_with_lease("server", Pairing::get().server, 1000ms);
  const auto client = entity_with_lease("client", Pairing::get().client, 1000ms);
  const calls::Address address{"test/LouderEcho", server->broker().new_provider()};
  const Opener opener(EntityAccess::participant(*server), address, [](const wire::RequestId& id) {
    return first(answer_to_open(id, wire::RemoteException::Ok), 20);
  });
  const auto registration = server->broker().add_service(describe_echo(address.provider, "server"));
  CHECK_THROWS_WITH(client->connect<LouderEcho>({.provider = address.provider, .timeout = 3s}),
                    Catch::Contains("malformed replies came") && Catch::Contains("truncated"));
}

TEST_CASE("a foreign server that calls `open` unknown or unsupported is ready") {
  const auto server = entity_with_lease("server", Pairing::get().server, 1000ms);
  const auto client = entity_with_lease("client", Pairing::get().client, 1000ms);
  const auto answer =
      GENERATE(wire::RemoteException::UnknownOperation, wire::RemoteException::Unsupported);
  const Opener opener(EntityAccess::participant(*server), {"test/LouderEcho", Guid{}},
                      [&](const wire::RequestId& id) { return answer_to_open(id, answer); });
  CHECK_NOTHROW(client->connect<LouderEcho>({.timeout = 20s, .foreign = true}));
}
