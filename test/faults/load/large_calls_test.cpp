#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdio>
#include <optional>
#include <thread>

#include "socket_buffers.hpp"
#include "test/connector/echo_service.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;

namespace {

constexpr std::size_t kLarge = 64 << 20;
constexpr auto kDeadline = 120s;

std::vector<std::uint8_t> large_content() {
  std::vector<std::uint8_t> content(kLarge);
  std::uint32_t value = 1;
  for (auto& octet : content)
    octet = static_cast<std::uint8_t>((value = value * 1664525 + 1013904223) >> 24);
  return content;
}

/// Calls one after the other on a thread of its own, and notes how long each took.
class SmallCalls {
 public:
  explicit SmallCalls(LouderEcho::Proxy proxy)
      : proxy_(std::move(proxy)), thread_([this] { run(); }) {}
  ~SmallCalls() { end(); }

  void end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  std::size_t done() const { return done_; }
  std::size_t failed() const { return failed_; }

  /// Prints the latencies of calls `first` to `last`; after end().
  void report(const char* when, std::size_t first, std::size_t last) {
    std::vector<double> part(took_us_.begin() + static_cast<std::ptrdiff_t>(first),
                             took_us_.begin() + static_cast<std::ptrdiff_t>(last));
    std::ranges::sort(part);
    std::printf("  small calls %s: %zu, p50 %.0f us, p99 %.0f us, max %.0f us\n", when, part.size(),
                part[part.size() / 2], part[part.size() * 99 / 100], part.back());
  }

 private:
  void run() {
    while (!stop_) {
      const auto begin = std::chrono::steady_clock::now();
      try {
        if (proxy_.within(10s).echo("small") != "small") ++failed_;
      } catch (const Error& error) {
        ++failed_;
        std::printf("  a small call failed: %s\n", error.what());
      }
      took_us_.push_back(
          std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
              .count());
      ++done_;
    }
  }

  LouderEcho::Proxy proxy_;
  std::vector<double> took_us_;
  std::atomic<std::size_t> done_{0};
  std::atomic<std::size_t> failed_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// A provider with two services, and a client of each.
struct Stage {
  std::unique_ptr<Entity> server = make_server();
  std::unique_ptr<Entity> client = make_client();
  LouderEcho::Proxy large = connect();
  LouderEcho::Proxy small = connect();

  LouderEcho::Proxy connect() {
    const Guid service = server->provide<LouderEcho>(std::make_shared<EchoService>());
    return client->connect<LouderEcho>({.provider = service, .timeout = 20s});
  }
};

void call_with_64_mib() {
  Stage stage;
  const auto content = large_content();
  SmallCalls small(stage.small);
  REQUIRE(eventually([&] { return small.done() >= 1000; }));

  const std::size_t before = small.done();
  const auto begin = std::chrono::steady_clock::now();
  const bool same = stage.large.within(kDeadline).echo_octets(content) == content;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const std::size_t after = small.done();
  small.end();

  CHECK(same);
  CHECK(small.failed() == 0);
  CHECK(after - before >= 10);
  std::printf("%s server, %s client: 64 MiB there and back in %.2f s\n",
              Pairing::get().server->name().c_str(), Pairing::get().client->name().c_str(),
              took.count());
  small.report("alone", 0, before);
  small.report("meanwhile", before, after);
}

/// Makes so many calls at once. One whose request found no room is made again: Overloaded says that
/// nothing was sent.
template <class Result, class Make>
void expect_answers(std::size_t count, const Result& expected, Make make) {
  while (count > 0) {
    std::vector<Call<Result>> calls;
    for (std::size_t i = 0; i < count; ++i) calls.push_back(make());
    for (auto& call : calls) {
      try {
        const Result answer = call.get();
        --count;
        CHECK(answer == expected);
      } catch (const Overloaded&) {
      }
    }
  }
}

}  // namespace

TEST_CASE("64 MiB go in one call, and small calls of another service go on meanwhile") {
  call_with_64_mib();
}

TEST_CASE("64 MiB go in one call with the system's default socket buffers") {
  const SocketBuffersOfAtMost host(kDefaultSocketBuffer);
  const int udp = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  int room = 4 << 20;
  setsockopt(udp, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
  socklen_t size = sizeof room;
  getsockopt(udp, SOL_SOCKET, SO_RCVBUF, &room, &size);
  close(udp);
  REQUIRE(room == 2 * kDefaultSocketBuffer);  // Linux doubles what it is asked for
  call_with_64_mib();
}

TEST_CASE("small answers behind one of 64 MiB on the same connection all arrive") {
  const SocketBuffersOfAtMost host(kDefaultSocketBuffer);
  const auto server = make_server();
  const auto client = make_client();
  const auto service = std::make_shared<EchoService>();
  server->provide<LouderEcho>(service);
  auto echo = client->connect<LouderEcho>({.timeout = 20s});
  const auto content = large_content();
  auto large = echo.within(kDeadline).async_echo_octets(content);
  REQUIRE(eventually([&] { return service->calls > 0; }, kDeadline));
  expect_answers<std::string>(200, "small", [&] { return echo.within(30s).async_echo("small"); });
  CHECK(large.get() == content);
}

TEST_CASE_METHOD(Stage, "many large answers to one client all arrive") {
  const SocketBuffersOfAtMost host(kDefaultSocketBuffer);
  const std::vector<std::uint8_t> content(1 << 20, 7);
  expect_answers(64, content, [&] { return large.within(60s).async_echo_octets(content); });
}

TEST_CASE_METHOD(Stage,
                 "a call that carries more than any provider takes is refused, with the limit") {
  const std::vector<std::uint8_t> content(std::size_t{256} << 20);
  CHECK_THROWS_AS(large.within(kDeadline).echo_octets(content), InvalidArgument);
  CHECK_THROWS_WITH(large.within(kDeadline).echo_octets(content),
                    Catch::StartsWith("the request of 'echo_octets' takes 2684355") &&
                        Catch::Contains(" bytes; readers take 268435456 (256 MiB) at most"));
}
