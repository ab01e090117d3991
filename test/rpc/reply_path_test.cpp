#include "rpc/server/reply_path.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "rpc/wire/reply_reading.hpp"
#include "skein/clock.hpp"

using namespace skein;
using namespace skein::rpc;
using namespace std::chrono_literals;

namespace {

Bytes message_of(const std::string& text) { return Bytes(std::as_bytes(std::span(text))); }

/// A client's end: what it has received, and whether it takes more.
struct Client {
  std::vector<std::string> received;
  bool takes = true;
  bool gone = false;
};

class Sender final : public calls::Sender {
 public:
  explicit Sender(Client& client) : client_(client) {}
  void send(std::span<const std::byte> message, const std::function<Duration()>&) override {
    if (client_.gone) throw Internal("the wire is cut");
    if (!client_.takes) throw Overloaded("no room");
    client_.received.emplace_back(reinterpret_cast<const char*>(message.data()), message.size());
  }
  bool send_lending(std::span<const std::byte>, const std::shared_ptr<LoanMemory>&,
                    std::size_t) override {
    return false;
  }
  bool await_taken(std::chrono::milliseconds) override { return client_.takes; }
  Guid identity() const override { return {}; }

 private:
  Client& client_;
};

/// Replies of a server to two clients; time passes, and `control` works, when the test says so.
struct Replies {
  Replies() {
    path->open(std::make_shared<Sender>(client));
    other_path->open(std::make_shared<Sender>(other));
  }

  bool send(const std::string& text, Duration left = 1min) {
    Bytes message = message_of(text);
    return path->send(path->sender(), message, clock.after(left));
  }
  void pass(Duration time) {
    clock.advance(time);
    control.run_all();
  }

  ManualClock clock;
  ManualExecutor control;
  Client client;
  Client other;
  const std::shared_ptr<ReplyContext> context{
      new ReplyContext{control, clock, {"test/Desk", Guid::random()}}};
  const std::shared_ptr<ReplyPath> path = std::make_shared<ReplyPath>(context);
  const std::shared_ptr<ReplyPath> other_path = std::make_shared<ReplyPath>(context);
};

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE_METHOD(Replies, "replies that find no room are sent later, in their order, and once") {
  CHECK(send("1"));
  client.takes = false;
  CHECK(send("2"));
  client.takes = true;
  CHECK(send("3"));  // behind the one that waits
  CHECK(client.received == Texts{"1"});
  CHECK(context->unsent == 2);
  pass(5ms);
  pass(5ms);
  CHECK(client.received == Texts{"1", "2", "3"});
  CHECK(context->unsent == 0);
  CHECK(send("4"));
  CHECK(client.received == Texts{"1", "2", "3", "4"});
  CHECK(context->lost == 0);
}

TEST_CASE_METHOD(Replies, "a reply that finds no room until its deadline is lost, and counted") {
  client.takes = false;
  CHECK(send("short", 100ms));
  CHECK(send("long", 10min));
  pass(100ms);
  CHECK(context->lost == 1);
  client.takes = true;
  pass(10s);
  CHECK(client.received == Texts{"long"});
  CHECK(context->unsent == 0);
}

TEST_CASE_METHOD(Replies, "a client that takes nothing holds up no other") {
  client.takes = false;
  CHECK(send("1"));
  for (int i = 0; i < 100; ++i) pass(5ms);
  Bytes message = message_of("2");
  CHECK(other_path->send(other_path->sender(), message, clock.after(1min)));
  CHECK(other.received == Texts{"2"});
  CHECK(context->lost == 0);
}

TEST_CASE_METHOD(Replies, "a client may have half of what waits for room in all, and then a half") {
  client.takes = other.takes = false;
  const std::string quarter(ReplyContext::kMaxUnsent / 4, 'x');
  CHECK(send(quarter));
  CHECK(send(quarter));
  CHECK_FALSE(send(quarter));
  CHECK(context->lost == 1);
  Bytes message = message_of(quarter);
  CHECK(other_path->send(other_path->sender(), message, clock.after(1min)));
}

TEST_CASE_METHOD(Replies, "once it is closed nothing is sent, and what waited counts no more") {
  client.takes = false;
  CHECK(send("1"));
  CHECK(path->close() != nullptr);
  CHECK(context->unsent == 0);
  client.takes = true;
  pass(1min);
  CHECK_FALSE(send("2"));
  CHECK(client.received.empty());
  CHECK(path->close() == nullptr);
}

TEST_CASE_METHOD(Replies, "a reply that cannot be sent is lost, and counted") {
  client.gone = true;
  CHECK_FALSE(send("1"));
  CHECK(context->lost == 1);
  CHECK(context->unsent == 0);
}

TEST_CASE_METHOD(Replies, "refusals leave from `control`; of more than 4096 the oldest go") {
  const Guid caller = Guid::random();
  for (std::uint64_t number = 1; number <= 5000; ++number)
    path->refuse({caller, number}, ErrorCode::Overloaded, "full");
  CHECK(client.received.empty());
  control.run_all();
  REQUIRE(client.received.size() == 4096);
  const auto first = wire::read_reply_head(message_of(client.received.front()));
  CHECK(first.related.client == caller);
  CHECK(first.related.number == 905);
}
