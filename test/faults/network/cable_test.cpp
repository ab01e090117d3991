#include "test/tools/cable.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "test/tools/eventually.hpp"
#include "test/tools/seed.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

constexpr std::uint16_t kPort = 4000;
constexpr int kSent = 2000;

/// A socket that lives in a namespace.
int udp_socket(const NetworkSpace& space) {
  const Inside inside(space);
  return socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
}

/// A sender and a receiver of numbers at the two ends of a cable.
struct Ends {
  Ends() : sender(udp_socket(one)), receiver(udp_socket(other)) {
    address.sin_family = AF_INET;
    address.sin_port = htons(kPort);
    inet_pton(AF_INET, "10.77.0.2", &address.sin_addr);
    const int room = 8 << 20;
    setsockopt(receiver, SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof room);
    REQUIRE(bind(receiver, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  }
  ~Ends() {
    close(sender);
    close(receiver);
  }

  void send_all() {
    for (int number = 0; number < kSent; ++number) {
      REQUIRE(sendto(sender, &number, sizeof number, 0, reinterpret_cast<sockaddr*>(&address),
                     sizeof address) == sizeof number);
    }
  }

  std::vector<int> receive_all() {
    std::vector<int> numbers;
    const auto arrived = [&] {
      int number = 0;
      while (recv(receiver, &number, sizeof number, 0) == sizeof number) numbers.push_back(number);
      const auto counters = cable.counters();
      return numbers.size() == counters.carried && counters.carried + counters.lost == expected();
    };
    CHECK(eventually(arrived));
    return numbers;
  }

  std::uint64_t expected() const { return kSent + cable.counters().duplicated; }

  NetworkSpace one;
  NetworkSpace other;
  Cable cable{one, other, seed_of_this_run()};
  int sender;
  int receiver;
  sockaddr_in address{};
};

}  // namespace

TEST_CASE("an undisturbed cable carries everything, once and in order") {
  Ends ends;
  ends.send_all();
  const auto numbers = ends.receive_all();
  CHECK(numbers.size() == kSent);
  CHECK(std::ranges::is_sorted(numbers));
}

TEST_CASE("a cable loses and duplicates the share that it is told, and nothing once it is cut") {
  Ends ends;
  ends.cable.disturb(Disturbance{.loss = 0.2, .duplication = 0.3});
  ends.send_all();
  const auto numbers = ends.receive_all();
  const auto counters = ends.cable.counters();
  CHECK(counters.lost > kSent / 10);
  CHECK(counters.lost < kSent * 3 / 10);
  CHECK(counters.duplicated > kSent * 15 / 100);
  CHECK(counters.duplicated < kSent * 35 / 100);
  ends.cable.disturb(Disturbance::cut());
  ends.send_all();
  CHECK(eventually([&] { return ends.cable.counters().lost == counters.lost + kSent; }));
  CHECK(ends.cable.counters().carried == counters.carried);
}

TEST_CASE("a cable that reorders or jitters loses nothing") {
  Ends ends;
  ends.cable.disturb(GENERATE(Disturbance{.reordering = 0.2}, Disturbance{.jitter = 20ms}));
  ends.send_all();
  auto numbers = ends.receive_all();
  CHECK_FALSE(std::ranges::is_sorted(numbers));
  CHECK(ends.cable.counters().overtaken > 0);
  std::ranges::sort(numbers);
  CHECK(numbers.size() == kSent);
  CHECK(std::ranges::adjacent_find(numbers) == numbers.end());
}
