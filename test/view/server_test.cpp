#include "view/server.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "skein/error.hpp"
#include "test/tools/eventually.hpp"
#include "web_client.hpp"

using namespace skein;
using namespace skein::view;
using Catch::Contains, Catch::EndsWith, Catch::StartsWith;
using skein::test::eventually, skein::test::WebClient;

namespace {

Options options() {
  Options options;
  options.name = "test";
  options.port = 0;
  options.token = "0123456789abcdef";
  return options;
}

std::string subscribe(std::uint32_t id, ChannelId channel) {
  return R"({"op":"subscribe","subscriptions":[{"id":)" + std::to_string(id) + R"(,"channelId":)" +
         std::to_string(channel) + "}]}";
}

std::string unsubscribe(std::uint32_t id) {
  return R"({"op":"unsubscribe","subscriptionIds":[)" + std::to_string(id) + "]}";
}

std::string call_frame(ServiceId service, std::string_view encoding, std::string_view request) {
  std::string bytes("\x02", 1);
  bytes += static_cast<char>(service);
  bytes.append(3, '\0');
  bytes += std::string("\x07\0\0\0", 4);
  bytes += static_cast<char>(encoding.size());
  bytes.append(3, '\0');
  bytes += encoding;
  bytes += request;
  return bytes;
}

void send(Server& server, ChannelId channel, std::string_view text) {
  server.send(channel, 0x0102030405060708, std::as_bytes(std::span(text)));
}

/// A channel of which it is known how often anybody watches it.
struct WatchedChannel {
  explicit WatchedChannel(Server& server, const std::string& topic = "topic")
      : id(server.add_channel({topic, "Type", "struct Type {};"},
                              [this](ChannelId, bool watched) { watched ? ++begun : ++ended; })) {}

  bool is_watched() {
    return eventually([&] { return begun == ended + 1; });
  }
  bool is_left() {
    return eventually([&] { return begun > 0 && begun == ended; });
  }

  std::atomic<int> begun{0};
  std::atomic<int> ended{0};
  const ChannelId id;
};

}  // namespace

TEST_CASE("A client is told of the server, its channels and its services, also of those to come") {
  Server server(options());
  server.add_channel({"early", "A::T", "module A {};"});
  WebClient client(server.url());
  CHECK_THAT(client.ask(), StartsWith("HTTP/1.1 101") &&
                               Contains("Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"));
  CHECK_THAT(client.receive()->bytes,
             Contains(R"("op":"serverInfo")") && Contains(R"("name":"test")"));
  CHECK(
      client.receive()->bytes ==
      R"({"op":"advertise","channels":[{"id":1,"topic":"early","encoding":"cdr","schemaName":"A::T","schemaEncoding":"omgidl","schema":"module A {};"}]})");
  const ChannelId late = server.add_channel({"late", "A::T", ""});
  CHECK_THAT(client.receive()->bytes, Contains(R"("topic":"late")"));
  server.remove_channel(late);
  CHECK(client.receive()->bytes == R"({"op":"unadvertise","channelIds":[2]})");
  const ServiceId service = server.add_service({"plan", "A::I"}, nullptr);
  CHECK_THAT(client.receive()->bytes,
             Contains(R"("op":"advertiseServices")") && Contains(R"("name":"plan")"));
  server.remove_service(service);
  CHECK(client.receive()->bytes == R"({"op":"unadvertiseServices","serviceIds":[1]})");
}

TEST_CASE("Samples go to those who have subscribed, with time and subscription, and to no others") {
  Server server(options());
  WatchedChannel channel(server);
  WebClient client(server.url());
  WebClient other(server.url());
  REQUIRE(client.open());
  REQUIRE(other.open());
  client.send_text(subscribe(258, channel.id));
  REQUIRE(channel.is_watched());
  send(server, channel.id, "hello");
  while (const auto message = client.receive()) {
    if (message->text) continue;
    CHECK(message->bytes ==
          std::string("\x01\x02\x01\0\0\x08\x07\x06\x05\x04\x03\x02\x01hello", 18));
    break;
  }
  server.add_channel({"end", "T", ""});
  CHECK_THAT(other.await("end"), !Contains("hello"));
}

TEST_CASE("A channel's owner is told when the first watches it, and when the last has left") {
  Server server(options());
  WatchedChannel channel(server);
  WebClient first(server.url());
  REQUIRE(first.open());
  first.send_text(subscribe(1, channel.id));
  REQUIRE(channel.is_watched());
  {
    WebClient second(server.url());
    REQUIRE(second.open());
    second.send_text(subscribe(1, channel.id));
    second.send_text("{}");
    second.await("status");
    first.send_text(unsubscribe(1));
    first.send_text("{}");
    first.await("status");
    CHECK(channel.begun == 1);
    CHECK(channel.ended == 0);
  }
  CHECK(channel.is_left());
  CHECK(channel.begun == 1);
}

TEST_CASE("Who watches a channel that is removed has left it, and may not watch it again") {
  Server server(options());
  WatchedChannel channel(server);
  WebClient client(server.url());
  REQUIRE(client.open());
  client.send_text(subscribe(1, channel.id));
  REQUIRE(channel.is_watched());
  server.remove_channel(channel.id);
  CHECK(channel.is_left());
  client.send_text(subscribe(2, channel.id));
  CHECK_THAT(client.await("no channel"), Contains("there is no channel 1"));
  client.send_text(unsubscribe(1));  // as clients do that were told
  client.send_text(unsubscribe(1));
  CHECK_THAT(client.receive()->bytes, Contains("there is no subscription 1 to end"));
}

TEST_CASE("Clients are told why a channel cannot be watched") {
  Server server(options());
  const ChannelId channel =
      server.add_channel({"topic", "T", ""}, [](ChannelId, bool) { throw Internal("no memory"); });
  WebClient client(server.url());
  REQUIRE(client.open());
  client.send_text(subscribe(1, channel));
  CHECK_THAT(client.await("status"), Contains("topic: no memory"));
}

TEST_CASE("What a client may not say is answered by a status, and the client stays") {
  Server server(options());
  WatchedChannel channel(server);
  WebClient client(server.url());
  REQUIRE(client.open());
  const auto answer_to = [&](const std::string& text) {
    client.send_text(text);
    return client.await(R"("op":"status","level":2)");
  };
  CHECK_THAT(answer_to("nonsense"), Contains("no JSON"));
  CHECK_THAT(answer_to(R"({"op":"getParameters"})"), Contains("not offered here"));
  CHECK_THAT(answer_to("{\"op\":\"a\\u001b[31m\"}"), Contains("a\\\\x1b[31m"));
  CHECK_THAT(answer_to(unsubscribe(3)), Contains("no subscription 3"));
  CHECK_THAT(answer_to(subscribe(1, channel.id) + "x"), Contains("no JSON"));
  client.send_text(subscribe(1, channel.id));
  CHECK_THAT(answer_to(subscribe(2, channel.id)), Contains("already"));
  CHECK_THAT(answer_to(subscribe(1, channel.id)), Contains("already"));
  client.send_binary(std::string("\x02\x01", 2));
  CHECK_THAT(client.await("status"), Contains("too early"));
  client.send_binary("");
  CHECK_THAT(client.await("status"), Contains("too early"));
  CHECK(channel.is_watched());
}

TEST_CASE("Services answer, at once or later, or fail; each call ends once") {
  Server server(options());
  std::optional<Answer> later;
  std::atomic<bool> called{false};
  server.add_service({"echo", "T"}, [](std::string_view request, const Answer& answer) {
    answer.respond(std::string(request));
    answer.fail("too late");
  });
  server.add_service({"later", "T"}, [&](std::string_view, const Answer& answer) {
    later = answer;
    called = true;
  });
  server.add_service({"none", "T"}, [](std::string_view, const Answer&) {});
  server.add_service({"throws", "T"},
                     [](std::string_view, const Answer&) { throw Unavailable("nobody there"); });
  WebClient client(server.url());
  REQUIRE(client.open());
  client.send_binary(call_frame(1, "json", "[1]"));
  CHECK(client.await("[1]") == std::string("\x03\x01\0\0\0\x07\0\0\0\x04\0\0\0json[1]", 20));
  client.send_binary(call_frame(2, "json", ""));
  REQUIRE(eventually([&] { return called.load(); }));
  client.send_binary(call_frame(3, "json", ""));
  CHECK(
      client.await("serviceCallFailure") ==
      R"({"op":"serviceCallFailure","serviceId":3,"callId":7,"message":"the service has given no answer"})");
  client.send_binary(call_frame(4, "json", ""));
  CHECK_THAT(client.await("serviceCallFailure"), Contains("nobody there"));
  client.send_binary(call_frame(1, "cdr", ""));
  CHECK_THAT(client.await("serviceCallFailure"), Contains("not as 'cdr'"));
  client.send_binary(call_frame(9, "json", ""));
  CHECK_THAT(client.await("serviceCallFailure"), Contains("no service 9"));
  later->respond("late");
  CHECK_THAT(client.await("late"), !Contains("too late"));
  server.close();
  later->respond("much too late");
}

TEST_CASE("Those who look at the graph are told what has changed") {
  Server server(options());
  server.set_graph({{{"t", {"a"}}}, {}, {{"s", {"a"}}}});
  WebClient client(server.url());
  REQUIRE(client.open());
  client.send_text(R"({"op":"subscribeConnectionGraph"})");
  CHECK(
      client.await("connectionGraphUpdate") ==
      R"({"op":"connectionGraphUpdate","publishedTopics":[{"name":"t","publisherIds":["a"]}],"subscribedTopics":[],"advertisedServices":[{"name":"s","providerIds":["a"]}],"removedTopics":[],"removedServices":[]})");
  server.set_graph({{{"t", {"a"}}}, {}, {}});
  CHECK_THAT(client.await("connectionGraphUpdate"),
             Contains(R"("publishedTopics":[],)") && Contains(R"("removedServices":["s"])"));
  client.send_text(R"({"op":"unsubscribeConnectionGraph"})");
  client.send_text("{}");
  client.await("status");
  server.set_graph({});
  server.add_channel({"end", "T", ""});
  CHECK_THAT(client.receive()->bytes, Contains(R"("topic":"end")"));
}

TEST_CASE("A client that does not read loses the oldest samples, and is told; others lose none") {
  auto small = options();
  small.queue = 1 << 20;
  Server server(small);
  WatchedChannel channel(server);
  WebClient stalled(server.url());
  WebClient reader(server.url());
  REQUIRE(stalled.open());
  REQUIRE(reader.open());
  stalled.send_text(subscribe(1, channel.id));
  reader.send_text(subscribe(2, channel.id));
  reader.send_text("{}");
  reader.await("status");
  REQUIRE(channel.is_watched());
  stalled.send_text("{}");
  stalled.await("status");  // both have subscribed
  constexpr int kSamples = 200;
  for (int i = 0; i < kSamples; ++i) {  // far more than its socket takes
    const std::string number = "#" + std::to_string(i) + '#';
    send(server, channel.id, number + std::string(100'000, '.'));
    REQUIRE_THAT(reader.await(number), Contains(number));
  }
  CHECK_THAT(stalled.await(R"("op":"status")"),
             Contains("dropped so far") && Contains(R"("level":1)"));
  CHECK_THAT(stalled.await("#199#"), Contains("#199#"));
}

TEST_CASE("Little waits in the kernel for a client that does not read: it would become old there") {
  auto small = options();
  small.queue = 50'000;  // the newest sample alone
  Server server(small);
  WatchedChannel channel(server);
  WebClient stalled(server.url());
  REQUIRE(stalled.open());
  stalled.send_text(subscribe(1, channel.id));
  REQUIRE(channel.is_watched());
  constexpr int kSamples = 60;
  for (int i = 0; i < kSamples; ++i)
    send(server, channel.id, "#" + std::to_string(i) + '#' + std::string(100'000, '.'));
  int old = 0;
  for (auto sample = stalled.receive(); sample && sample->bytes.find("#59#") == std::string::npos;
       sample = stalled.receive())
    ++old;
  CHECK(old < 10);
}

TEST_CASE("A client that reads a large sample slowly all the time is not dropped") {
  auto impatient = options();
  impatient.patience = std::chrono::milliseconds(400);
  Server server(impatient);
  WatchedChannel channel(server);
  WebClient slow(server.url());
  REQUIRE(slow.open());
  slow.send_text(subscribe(1, channel.id));
  REQUIRE(channel.is_watched());
  send(server, channel.id, std::string(16 << 20, '.') + "end");
  const auto reads_until_left = [&] { return channel.ended > 0 || !slow.take(20'000); };
  // At most 10 MB a second, so that the sample lasts longer.
  CHECK_FALSE(eventually(reads_until_left, 3 * impatient.patience));
  CHECK_THAT(slow.await("end"), EndsWith("end"));
}

TEST_CASE("Connections that say nothing do not keep those with the token out") {
  Server server(options());
  std::vector<std::unique_ptr<WebClient>> silent;
  for (int i = 0; i < 200; ++i) silent.push_back(std::make_unique<WebClient>(server.url()));
  CHECK(WebClient(server.url()).open());
  CHECK(silent.front()->is_ended());
}

TEST_CASE("Who has no token, offers no WebSocket or comes too late is refused with a reason") {
  auto one = options();
  one.max_clients = 1;
  Server server(one);
  CHECK_THAT(WebClient(server.url()).ask(WebClient::kHeaders, "/"),
             StartsWith("HTTP/1.1 401 Unauthorized"));
  CHECK_THAT(WebClient(server.url()).ask("Host: localhost\r\n"),
             StartsWith("HTTP/1.1 426 Upgrade Required"));
  WebClient client(server.url());
  REQUIRE(client.open());
  CHECK_THAT(WebClient(server.url()).ask(), StartsWith("HTTP/1.1 503"));
}

TEST_CASE("A client that has gone makes room for the next") {
  auto one = options();
  one.max_clients = 1;
  Server server(one);
  REQUIRE(WebClient(server.url()).open());
  CHECK(eventually([&] { return WebClient(server.url()).open(); }));
}

TEST_CASE("Who says nothing, nonsense or too much is dropped, and others are served on") {
  auto impatient = options();
  impatient.handshake = std::chrono::milliseconds(100);
  impatient.max_message = 1000;
  Server server(impatient);
  WebClient silent(server.url());
  CHECK(silent.is_ended());
  WebClient confused(server.url());
  confused.send_raw(std::string(20'000, 'x'));
  CHECK(confused.is_ended());
  WebClient talkative(server.url());
  REQUIRE(talkative.open());
  talkative.send_text(std::string(2000, ' '));
  CHECK(talkative.is_ended());
  CHECK(WebClient(server.url()).open());
}

TEST_CASE("A client of which nothing is heard, not even when it is asked, is dropped") {
  auto impatient = options();
  impatient.patience = std::chrono::milliseconds(200);
  Server server(impatient);
  WatchedChannel channel(server);
  WebClient mute(server.url());
  REQUIRE(mute.open());
  mute.send_text(subscribe(1, channel.id));
  REQUIRE(channel.is_watched());
  CHECK(channel.is_left());
}

TEST_CASE("Closing ends all connections, and callbacks") {
  std::atomic<int> calls{0};
  Server server(options());
  const ChannelId channel =
      server.add_channel({"topic", "T", ""}, [&](ChannelId, bool) { ++calls; });
  WebClient client(server.url());
  REQUIRE(client.open());
  client.send_text(subscribe(1, channel));
  server.close();
  const int before = calls;
  CHECK(client.is_ended());
  send(server, channel, "nobody");
  server.remove_channel(channel);
  server.set_graph({{{"t", {"a"}}}, {}, {}});
  CHECK(calls == before);
  server.close();
}

TEST_CASE("Clients may come, watch and go while channels and samples do") {
  Server server(options());
  std::atomic<bool> stop{false};
  // News of channels are never dropped: a client that cannot keep up with them would be.
  std::atomic<int> allowed{0};
  WatchedChannel channel(server);
  std::thread publisher([&] {
    for (int come_and_gone = 0; !stop;) {
      send(server, channel.id, std::string(1000, '.'));
      if (come_and_gone == allowed) continue;
      server.remove_channel(server.add_channel({"short-lived", "T", ""}));
      ++come_and_gone;
    }
  });
  for (int round = 0; round < 50; ++round) {
    WebClient client(server.url());
    allowed += 100;
    CHECK(client.open());
    client.send_text(subscribe(1, channel.id));
    CHECK_THAT(client.await(std::string(1000, '.')), StartsWith("\x01"));
  }
  stop = true;
  publisher.join();
  CHECK(channel.is_left());
}

TEST_CASE("An address that is none, or a port that is taken, is refused") {
  auto wrong = options();
  wrong.address = "localhost";
  CHECK_THROWS_AS(Server(wrong), InvalidArgument);
  Server server(options());
  auto same = options();
  const std::string url = server.url();
  same.port = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  CHECK_THROWS_WITH(Server(same), Contains("cannot be had"));
}
