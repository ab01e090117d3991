#include "same_host/call_ports.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "skein/detail/channel.hpp"
#include "skein/error.hpp"
#include "test/same_host/ring_all_doorbells.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

Guid participant() { return Guid::random().participant(); }

/// A provider's identity begins with its participant's.
Guid provider_of(const Guid& participant) {
  Guid provider = Guid::random();
  std::copy_n(participant.bytes.begin(), 12, provider.bytes.begin());
  return provider;
}

calls::Address at(const Guid& provider) { return {"test/Desk", provider}; }

std::vector<std::byte> message(const std::string& text) {
  std::vector<std::byte> content{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  for (const char letter : text) content.push_back(static_cast<std::byte>(letter));
  return content;
}

std::string text_of(std::span<const std::byte> cdr) {
  return {reinterpret_cast<const char*>(cdr.data()) + 4, cdr.size() - 4};
}

/// What a receiver or a sender was told, in order.
class Story {
 public:
  void add(std::string line) {
    std::lock_guard lock(mutex_);
    lines_.push_back(std::move(line));
  }
  bool becomes(const std::vector<std::string>& expected) {
    return eventually([&] {
      std::lock_guard lock(mutex_);
      return lines_ == expected;
    });
  }
  calls::Listener receiver() {
    return {[this](const calls::Message& message) {
              {
                std::lock_guard lock(mutex_);
                last_sender_ = message.sender;
              }
              add(text_of(message.bytes));
            },
            sender()};
  }
  calls::PeerListener sender() {
    return [this](const Guid&, bool found) { add(found ? "found" : "gone"); };
  }

  /// Nothing more is taken while the result lives.
  std::unique_lock<std::mutex> hold_up() { return std::unique_lock(mutex_); }

  Guid last_sender() {
    std::lock_guard lock(mutex_);
    return last_sender_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> lines_;
  Guid last_sender_;
};

/// Does with every memory that this process shares what a hostile peer would.
void damage(const std::function<void(RingState& requests, RingState& replies)>& how) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (line.find("memfd:skein") == std::string::npos) continue;
    void* begin = nullptr;
    REQUIRE(std::sscanf(line.c_str(), "%p", &begin) == 1);
    auto* const states = static_cast<RingState*>(begin);
    how(states[0], states[1]);
  }
}

void damage_replies() {
  damage([](RingState&, RingState& replies) { replies.written = 12; });
  test::ring_all_doorbells();
}

/// KiB of the greatest mapping of memory that this process shares.
std::size_t most_resident_kib() {
  std::ifstream maps("/proc/self/smaps");
  std::size_t most = 0;
  bool ours = false;
  for (std::string line; std::getline(maps, line);) {
    const bool begins = line.find(':') != std::string::npos && line.find('-') < line.find(' ');
    if (begins) ours = line.find("memfd:skein") != std::string::npos;
    if (ours && line.starts_with("Rss:")) most = std::max(most, std::stoul(line.substr(4)));
  }
  return most;
}

struct Pair {
  const Guid id = provider_of(participant());
  const Guid client = participant();
  Meeting meeting;
  ProviderPort providers{meeting, {id.participant()}};
  ClientPort clients{meeting, {client}};
  Story at_provider;
  std::unique_ptr<calls::Receiver> requests =
      providers.receive_requests(at(id), false, at_provider.receiver());

  auto send_requests(calls::PeerListener on_peer = {}) {
    return clients.send_requests(at(id), std::move(on_peer));
  }
  auto receive_replies(const calls::Sender& request, calls::Listener listener) {
    return clients.receive_replies(at(id), request.identity(), std::move(listener));
  }
  auto send_replies(const calls::Sender& request, calls::PeerListener on_peer = {}) {
    return providers.send_replies(at(id), request.identity(), std::move(on_peer));
  }
};

}  // namespace

TEST_CASE("a request reaches the provider, and its reply the client alone that has asked") {
  Pair pair;
  Story at_client;
  Story at_other;
  Story of_sender;
  const auto request = pair.send_requests(of_sender.sender());
  const auto replies = pair.receive_replies(*request, at_client.receiver());
  const auto other = pair.send_requests();
  const auto other_replies = pair.receive_replies(*other, at_other.receiver());
  CHECK(of_sender.becomes({"found"}));
  CHECK(request->identity() != other->identity());
  CHECK(request->identity().participant() == pair.client);
  REQUIRE(pair.at_provider.becomes({"found", "found"}));
  request->send(message("question"));
  REQUIRE(pair.at_provider.becomes({"found", "found", "question"}));
  CHECK(pair.at_provider.last_sender() == request->identity());
  const auto reply = pair.send_replies(*request, of_sender.sender());
  reply->send(message("answer"));
  CHECK(at_client.becomes({"found", "answer"}));
  CHECK(at_client.last_sender().participant() == pair.id.participant());
  CHECK(at_other.becomes({"found"}));
  CHECK(request->await_taken(1s));
}

TEST_CASE("a connection that has carried small calls keeps at most 64 KiB of memory") {
  Pair pair;
  Story at_client;
  const auto request = pair.send_requests();
  const auto replies = pair.receive_replies(*request, at_client.receiver());
  std::vector<std::string> at_provider{"found"};
  std::vector<std::string> received{"found"};
  REQUIRE(pair.at_provider.becomes(at_provider));
  const auto reply = pair.send_replies(*request);
  for (int i = 0; i < 1000; ++i) {
    request->send(message(std::string(1024, 'q')));
    at_provider.push_back(std::string(1024, 'q'));
    REQUIRE(request->await_taken(20s));
    reply->send(message(std::string(1024, 'a')));
    received.push_back(std::string(1024, 'a'));
    REQUIRE(reply->await_taken(20s));
  }
  CHECK(pair.at_provider.becomes(at_provider));
  CHECK(at_client.becomes(received));
  const std::size_t kib = most_resident_kib();
  CHECK(kib > 0);
  CHECK(kib <= 64);
}

TEST_CASE("a sender knows of a provider's end before anything tells of it") {
  Pair pair;
  const auto request = pair.send_requests();
  pair.requests.reset();
  CHECK_THROWS_AS(request->send(message("late")), NotSent);
}

TEST_CASE("whichever side goes, the other one is told once, after all that was sent") {
  Pair pair;
  Story at_client;
  Story of_sender;
  auto request = pair.send_requests(of_sender.sender());
  auto replies = pair.receive_replies(*request, at_client.receiver());
  request->send(message("last"));
  if (GENERATE(true, false)) {
    replies.reset();
    request.reset();
    CHECK(pair.at_provider.becomes({"found", "last", "gone"}));
  } else {
    REQUIRE(pair.at_provider.becomes({"found", "last"}));
    pair.requests.reset();
    CHECK(at_client.becomes({"found", "gone"}));
    CHECK(of_sender.becomes({"found", "gone"}));
    CHECK_THROWS_AS(request->send(message("more")), Unavailable);
  }
}

TEST_CASE(
    "a sender whose provider is not there is refused, and one whose client has gone is mute") {
  Pair pair;
  CHECK_THROWS_AS(pair.clients.send_requests(at(Guid::random()), {}), Unavailable);
  Story of_mute;
  const auto mute = pair.providers.send_replies(at(pair.id), Guid::random(), of_mute.sender());
  CHECK_NOTHROW(mute->send(message("nobody")));
  CHECK(of_mute.becomes({}));
}

TEST_CASE("who takes nothing is told of as overloaded, and gets the rest once it takes again") {
  Pair pair;
  std::mutex gate;
  std::atomic<std::size_t> taken = 0;
  const auto request = pair.send_requests();
  calls::Listener slow{[&](const calls::Message&) {
    std::lock_guard lock(gate);
    ++taken;
  }};
  const auto replies = pair.receive_replies(*request, std::move(slow));
  request->send(message("hello"));
  REQUIRE(pair.at_provider.becomes({"found", "hello"}));
  const auto reply = pair.send_replies(*request);
  std::size_t written = 0;
  {
    std::lock_guard lock(gate);
    const auto large = message(std::string(40'000, 'x'));
    for (; written < 2; ++written) reply->send(large);
    CHECK_THROWS_AS(
        [&] {
          for (; written < 1000; ++written) reply->send(large);
        }(),
        Overloaded);
    CHECK_FALSE(reply->await_taken(0ms));
  }
  CHECK(reply->await_taken(20s));
  reply->send(message("after"));
  CHECK(eventually([&] { return taken == written + 1; }));
}

TEST_CASE("a message waits for room no longer than its sender has time") {
  Pair pair;
  std::size_t waited = 0;
  const auto request = pair.clients.send_requests(at(pair.id), {}, [&] { ++waited; });
  const auto large = message(std::string(40'000, 'x'));
  std::size_t asked = 0;
  const auto left = [&] {
    ++asked;
    return Duration::zero();
  };
  const auto holds_up = pair.at_provider.hold_up();
  request->send(large, left);
  CHECK(asked == 0);
  CHECK(waited == 0);
  CHECK_THROWS_AS(
      [&] {
        for (int i = 0; i < 1000; ++i) request->send(large, left);
      }(),
      Overloaded);
  CHECK(asked == 1);
  CHECK(waited == 1);
}

TEST_CASE("what is no message is dropped and counted") {
  Pair pair;
  const auto request = pair.send_requests();
  request->send(std::vector<std::byte>(4, std::byte{9}));
  request->send(message("good"));
  CHECK(pair.at_provider.becomes({"found", "good"}));
  CHECK(pair.requests->malformed() == 1);
}

TEST_CASE("a provider that has damaged what it shared is not met there again") {
  const Guid id = provider_of(participant());
  Meeting meeting;
  ClientPort clients(meeting, {participant()});
  std::shared_ptr<Link> link;  // the meeting's thread's
  meeting.offer(
      id, id, [] {}, [&](std::shared_ptr<Link> made) { link = std::move(made); });
  Story at_client;
  const auto request = clients.send_requests(at(id), {});
  const auto replies = clients.receive_replies(at(id), request->identity(), at_client.receiver());
  REQUIRE(at_client.becomes({"found"}));
  damage_replies();
  CHECK(at_client.becomes({"found", "gone"}));
  CHECK_THROWS_WITH(clients.send_requests(at(id), {}), Catch::Contains("has damaged the memory"));
  meeting.withdraw(id);
}

TEST_CASE("who waits until all is taken is let go where the other side damages the memory") {
  Pair pair;
  const auto request = pair.send_requests();
  request->send(message("hello"));
  REQUIRE(pair.at_provider.becomes({"found", "hello"}));
  REQUIRE(request->await_taken(20s));
  damage([](RingState& requests, RingState&) { requests.read = 12; });
  CHECK_FALSE(request->await_taken(1h));
  CHECK_THROWS_AS(request->send(message("more")), Unavailable);
}
