// The messages to the clients of `skein designer`.
#include "command/designer/page_hub.hpp"

#include <catch2/catch.hpp>
#include <future>

#include "skein/error.hpp"
#include "test/tools/eventually.hpp"
#include "test/view/web_client.hpp"

using namespace skein;
using namespace skein::command::designer;
using skein::test::eventually, skein::test::WebClient;

namespace {

std::shared_ptr<const std::string> text(std::string of) {
  return std::make_shared<const std::string>(std::move(of));
}

/// A hub that admits clients without a token.
class OpenHub {
 public:
  using Obey = std::function<std::string(std::string_view)>;

  explicit OpenHub(const Obey& obey = [](std::string_view) { return std::string("done"); })
      : hub(std::make_shared<PageHub>(PageHub::Obey{
            obey, [](auto request) { return request.find("slow") != std::string::npos; }})),
        listener_(
            options(), [](const view::Visit&) { return std::nullopt; },
            [this](view::Connection& connection) { return hub->open(connection); }),
        url("ws://127.0.0.1:" + std::to_string(listener_.port()) + "/") {}

  static view::WebSocketOptions options() {
    return {"", "127.0.0.1", 0, 64, 4096, std::chrono::seconds(5), std::chrono::seconds(30)};
  }

  const std::shared_ptr<PageHub> hub;

 private:
  view::WebSocketListener listener_;

 public:
  const std::string url;
};

}  // namespace

TEST_CASE("a client gets the newest state when it comes, and each that follows") {
  OpenHub open;
  CHECK(!open.hub->is_watched());
  open.hub->publish(PageHub::Kind::Domain, text("1"));
  WebClient client(open.url);
  REQUIRE(client.open());
  CHECK(client.receive()->bytes == "1");
  CHECK(open.hub->is_watched());
  open.hub->publish(PageHub::Kind::Domain, text("2"));
  CHECK(client.receive()->bytes == "2");
}

TEST_CASE("who reads the state is interested for a while") {
  OpenHub open;
  CHECK(open.hub->look() == nullptr);
  CHECK(open.hub->is_watched());
}

TEST_CASE("a request is answered to who has asked, by its number") {
  OpenHub open([](std::string_view request) -> std::string {
    if (request.find("bad") != std::string_view::npos) throw InvalidArgument("it is bad");
    return "done";
  });
  WebClient client(open.url), other(open.url);
  REQUIRE((client.open() && other.open()));
  client.send_text(R"({"request": 7, "do": "x"})");
  CHECK(client.receive()->bytes == R"({"done":true,"request":7,"text":"done"})");
  client.send_text(R"({"request": 8, "do": "bad"})");
  CHECK(client.receive()->bytes == R"({"done":false,"request":8,"text":"it is bad"})");
  client.send_binary("x");
  CHECK(client.receive()->bytes == R"({"done":false,"request":null,"text":"requests are text"})");
  open.hub->publish(PageHub::Kind::Domain, text("state"));
  CHECK(other.receive()->bytes == "state");
}

TEST_CASE("who asks too much at once, or too long, is dropped, and the others stay") {
  std::promise<void> go_on;
  OpenHub open([ready = go_on.get_future().share()](std::string_view) {
    ready.wait();
    return std::string();
  });
  WebClient greedy(open.url), wordy(open.url), other(open.url);
  REQUIRE((greedy.open() && wordy.open() && other.open()));
  for (std::size_t i = 0; i <= PageHub::kRequests; ++i) greedy.send_text("{}");
  CHECK(greedy.is_ended());
  wordy.send_text(std::string(5000, ' '));
  CHECK(wordy.is_ended());
  open.hub->publish(PageHub::Kind::Domain, text("1"));
  CHECK(other.receive()->bytes == "1");
  go_on.set_value();
}

TEST_CASE("what has to wait for others holds up only what has to wait, too") {
  std::promise<void> go_on;
  OpenHub open([ready = go_on.get_future().share()](std::string_view request) {
    if (request.find("slow") != std::string_view::npos) ready.wait();
    return std::string("done");
  });
  WebClient client(open.url);
  REQUIRE(client.open());
  client.send_text(R"({"request": 1, "do": "slow"})");
  client.send_text(R"({"request": 2, "do": "quick"})");
  CHECK(client.receive()->bytes == R"({"done":true,"request":2,"text":"done"})");
  go_on.set_value();
  CHECK(client.receive()->bytes == R"({"done":true,"request":1,"text":"done"})");
}

TEST_CASE("a slow client skips states, and holds nobody up") {
  OpenHub open;
  WebClient slow(open.url), other(open.url);
  REQUIRE((slow.open() && other.open()));
  const std::string much(4 << 20, 'x');
  for (int i = 0; i < 20; ++i) {
    open.hub->publish(PageHub::Kind::Domain, text(std::to_string(i) + much));
    CHECK(other.receive()->bytes.starts_with(std::to_string(i) + "x"));
  }
  std::vector<std::string> seen;
  do seen.push_back(slow.receive()->bytes.substr(0, 2));
  while (seen.back() != "19");
  CHECK(seen.size() < 10);
}

TEST_CASE("fifty clients see the same") {
  OpenHub open;
  std::vector<std::unique_ptr<WebClient>> clients;
  for (int i = 0; i < 50; ++i) {
    clients.push_back(std::make_unique<WebClient>(open.url));
    REQUIRE(clients.back()->open());
  }
  open.hub->publish(PageHub::Kind::Domain, text("1"));
  for (const auto& client : clients) CHECK(client->receive()->bytes == "1");
  clients.clear();
  CHECK(eventually([&] { return !open.hub->is_watched(); }));
}
