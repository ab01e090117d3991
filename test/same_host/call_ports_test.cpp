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

#include "skein/error.hpp"
#include "test/same_host/ring_all_doorbells.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

const dds::Topic kRequests{"Test_Request", "Test_Request"};
const dds::Topic kReplies{"Test_Reply", "Test_Reply"};

Guid participant() { return Guid::random().participant(); }

/// A provider's identity begins with its participant's.
Guid provider_of(const Guid& participant) {
  Guid provider = Guid::random();
  std::copy_n(participant.bytes.begin(), 12, provider.bytes.begin());
  return provider;
}

dds::Qos in_partition(const Guid& peer) {
  dds::Qos qos;
  qos.partitions = {peer.hex()};
  return qos;
}

std::vector<std::byte> message(const std::string& text) {
  std::vector<std::byte> content{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  for (const char letter : text) content.push_back(static_cast<std::byte>(letter));
  return content;
}

std::string text_of(std::span<const std::byte> cdr) {
  return {reinterpret_cast<const char*>(cdr.data()) + 4, cdr.size() - 4};
}

/// What a reader or a writer was told, in order.
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
  dds::ReaderListener reader() {
    dds::ReaderListener listener;
    listener.on_data = [this](dds::Reader& reader) {
      reader.take([this](const dds::Sample& sample) {
        {
          std::lock_guard lock(mutex_);
          last_writer_ = sample.writer;
        }
        add(text_of(sample.cdr));
      });
    };
    listener.on_matched = matched();
    return listener;
  }
  dds::WriterListener writer() { return {matched()}; }

  /// Nothing more is taken while the result lives.
  std::unique_lock<std::mutex> hold_up() { return std::unique_lock(mutex_); }

  Guid last_writer() {
    std::lock_guard lock(mutex_);
    return last_writer_;
  }

 private:
  std::function<void(const Guid&, bool)> matched() {
    return [this](const Guid&, bool matched) { add(matched ? "matched" : "gone"); };
  }

  std::mutex mutex_;
  std::vector<std::string> lines_;
  Guid last_writer_;
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
  Meeting meeting;
  ProviderPort providers{meeting, {id.participant()}};
  ClientPort clients{meeting, {participant()}};
  Story at_provider;
  std::unique_ptr<dds::Reader> requests =
      providers.create_reader(kRequests, in_partition(id), at_provider.reader());
};

}  // namespace

TEST_CASE("a request reaches the provider, and its reply the client alone that has asked") {
  Pair pair;
  Story at_client;
  Story at_other;
  Story of_writer;
  const auto request =
      pair.clients.create_writer(kRequests, in_partition(pair.id), of_writer.writer());
  const auto replies =
      pair.clients.create_reader(kReplies, in_partition(request->guid()), at_client.reader());
  const auto other = pair.clients.create_writer(kRequests, in_partition(pair.id), {});
  const auto other_replies =
      pair.clients.create_reader(kReplies, in_partition(other->guid()), at_other.reader());
  CHECK(of_writer.becomes({"matched"}));
  CHECK(request->guid() != other->guid());
  CHECK(request->guid().participant() == pair.clients.guid());
  REQUIRE(pair.at_provider.becomes({"matched", "matched"}));
  request->write(message("question"));
  REQUIRE(pair.at_provider.becomes({"matched", "matched", "question"}));
  CHECK(pair.at_provider.last_writer() == request->guid());
  const auto reply =
      pair.providers.create_writer(kReplies, in_partition(request->guid()), of_writer.writer());
  reply->write(message("answer"));
  CHECK(at_client.becomes({"matched", "answer"}));
  CHECK(at_client.last_writer().participant() == pair.id.participant());
  CHECK(at_other.becomes({"matched"}));
  CHECK(request->wait_for_acknowledgments(1s));
}

TEST_CASE("a connection that has carried small calls keeps at most 64 KiB of memory") {
  Pair pair;
  Story at_client;
  const auto request = pair.clients.create_writer(kRequests, in_partition(pair.id), {});
  const auto replies =
      pair.clients.create_reader(kReplies, in_partition(request->guid()), at_client.reader());
  std::vector<std::string> at_provider{"matched"};
  std::vector<std::string> received{"matched"};
  REQUIRE(pair.at_provider.becomes(at_provider));
  const auto reply = pair.providers.create_writer(kReplies, in_partition(request->guid()), {});
  for (int i = 0; i < 1000; ++i) {
    request->write(message(std::string(1024, 'q')));
    at_provider.push_back(std::string(1024, 'q'));
    REQUIRE(request->wait_for_acknowledgments(20s));
    reply->write(message(std::string(1024, 'a')));
    received.push_back(std::string(1024, 'a'));
    REQUIRE(reply->wait_for_acknowledgments(20s));
  }
  CHECK(pair.at_provider.becomes(at_provider));
  CHECK(at_client.becomes(received));
  const std::size_t kib = most_resident_kib();
  CHECK(kib > 0);
  CHECK(kib <= 64);
}

TEST_CASE("whichever side goes, the other one is told once, after all that was sent") {
  Pair pair;
  Story at_client;
  Story of_writer;
  auto request = pair.clients.create_writer(kRequests, in_partition(pair.id), of_writer.writer());
  auto replies =
      pair.clients.create_reader(kReplies, in_partition(request->guid()), at_client.reader());
  request->write(message("last"));
  if (GENERATE(true, false)) {
    replies.reset();
    request.reset();
    CHECK(pair.at_provider.becomes({"matched", "last", "gone"}));
  } else {
    REQUIRE(pair.at_provider.becomes({"matched", "last"}));
    pair.requests.reset();
    CHECK(at_client.becomes({"matched", "gone"}));
    CHECK(of_writer.becomes({"matched", "gone"}));
    CHECK_THROWS_AS(request->write(message("more")), Unavailable);
  }
}

TEST_CASE(
    "a writer whose provider is not there is refused, and one whose client has gone is mute") {
  Pair pair;
  CHECK_THROWS_AS(pair.clients.create_writer(kRequests, in_partition(Guid::random()), {}),
                  Unavailable);
  CHECK_THROWS_AS(pair.clients.create_writer(kRequests, {}, {}), InvalidArgument);
  const auto mute = pair.providers.create_writer(kReplies, in_partition(Guid::random()), {});
  CHECK_NOTHROW(mute->write(message("nobody")));
  CHECK(mute->matched_readers().empty());
}

TEST_CASE("who takes nothing is told of as overloaded, and gets the rest once it takes again") {
  Pair pair;
  std::mutex gate;
  std::atomic<std::size_t> taken = 0;
  const auto request = pair.clients.create_writer(kRequests, in_partition(pair.id), {});
  dds::ReaderListener slow;
  slow.on_data = [&](dds::Reader& reader) {
    std::lock_guard lock(gate);
    taken += reader.take([](const dds::Sample&) {});
  };
  const auto replies =
      pair.clients.create_reader(kReplies, in_partition(request->guid()), std::move(slow));
  request->write(message("hello"));
  REQUIRE(pair.at_provider.becomes({"matched", "hello"}));
  auto qos = in_partition(request->guid());
  qos.max_blocking = 5ms;
  std::size_t waited = 0;
  dds::WriterListener listener;
  listener.on_full = [&] { ++waited; };
  const auto reply = pair.providers.create_writer(kReplies, qos, std::move(listener));
  std::size_t written = 0;
  {
    std::lock_guard lock(gate);
    const auto large = message(std::string(40'000, 'x'));
    for (; written < 2; ++written) reply->write(large);
    CHECK(waited == 0);
    CHECK_THROWS_AS(
        [&] {
          for (; written < 1000; ++written) reply->write(large);
        }(),
        Overloaded);
    CHECK(waited > 0);
    CHECK_FALSE(reply->wait_for_acknowledgments(0ms));
  }
  CHECK(reply->wait_for_acknowledgments(20s));
  reply->write(message("after"));
  CHECK(eventually([&] { return taken == written + 1; }));
}

TEST_CASE("a message waits for room no longer than its sender has time") {
  Pair pair;
  auto qos = in_partition(pair.id);
  qos.max_blocking = 1h;
  const auto request = pair.clients.create_writer(kRequests, qos, {});
  const auto large = message(std::string(40'000, 'x'));
  std::size_t asked = 0;
  const auto left = [&] {
    ++asked;
    return Duration::zero();
  };
  const auto holds_up = pair.at_provider.hold_up();
  request->write_within(left, large);
  CHECK(asked == 0);
  CHECK_THROWS_AS(
      [&] {
        for (int i = 0; i < 1000; ++i) request->write_within(left, large);
      }(),
      Overloaded);
  CHECK(asked == 1);
}

TEST_CASE("what is no message is dropped and counted, and a sample can be kept") {
  Pair pair;
  const auto request = pair.clients.create_writer(kRequests, in_partition(pair.id), {});
  std::shared_ptr<const void> kept;
  std::span<const std::byte> content;
  std::atomic<bool> came = false;
  dds::ReaderListener keeping;
  keeping.on_data = [&](dds::Reader& reader) {
    reader.take([&](const dds::Sample& sample) {
      kept = sample.keep();
      content = sample.cdr;
      came = true;
    });
  };
  const auto replies =
      pair.clients.create_reader(kReplies, in_partition(request->guid()), std::move(keeping));
  request->write(std::vector<std::byte>{std::byte{9}, std::byte{9}, std::byte{9}, std::byte{9}});
  request->write(message("good"));
  CHECK(pair.at_provider.becomes({"matched", "good"}));
  CHECK(pair.requests->counters().malformed == 1);
  const auto reply = pair.providers.create_writer(kReplies, in_partition(request->guid()), {});
  reply->write(message("first"));
  REQUIRE(eventually([&] { return came.load(); }));
  for (int i = 0; i < 100; ++i) request->write(message("more"));
  CHECK(text_of(content) == "first");
}

TEST_CASE("a provider that has damaged what it shared is not met there again") {
  const Guid id = provider_of(participant());
  Meeting meeting;
  ClientPort clients(meeting, {participant()});
  std::shared_ptr<Link> link;  // the meeting's thread's
  meeting.offer(
      id, id, [] {}, [&](std::shared_ptr<Link> made) { link = std::move(made); });
  Story at_client;
  const auto request = clients.create_writer(kRequests, in_partition(id), {});
  const auto replies =
      clients.create_reader(kReplies, in_partition(request->guid()), at_client.reader());
  REQUIRE(at_client.becomes({"matched"}));
  damage_replies();
  CHECK(at_client.becomes({"matched", "gone"}));
  CHECK_THROWS_WITH(clients.create_writer(kRequests, in_partition(id), {}),
                    Catch::Contains("has damaged the memory"));
  meeting.withdraw(id);
}

TEST_CASE("who waits until all is taken is let go where the other side damages the memory") {
  Pair pair;
  const auto request = pair.clients.create_writer(kRequests, in_partition(pair.id), {});
  request->write(message("hello"));
  REQUIRE(pair.at_provider.becomes({"matched", "hello"}));
  REQUIRE(request->wait_for_acknowledgments(20s));
  damage([](RingState& requests, RingState&) { requests.read = 12; });
  CHECK_FALSE(request->wait_for_acknowledgments(1h));
  CHECK_THROWS_AS(request->write(message("more")), Unavailable);
}
