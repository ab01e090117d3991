#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <queue>
#include <random>
#include <thread>
#include <tuple>
#include <vector>

#include "network_space.hpp"

namespace skein::test {

/// What a cable does to the packets that cross it. Shares are from 0 to 1.
struct Disturbance {
  double loss = 0;
  double duplication = 0;
  /// The share that is held back until later ones have passed.
  double reordering = 0;
  /// Each packet takes up to so much longer, evenly distributed; they may overtake each other.
  std::chrono::milliseconds jitter{};

  static Disturbance cut() { return {.loss = 1}; }
};

/// A cable between two network namespaces that the test disturbs as it likes, without a kernel that
/// can: device `skein0` in each, 10.77.0.1 in `one` and 10.77.0.2 in `other`, and a thread that
/// carries IPv4 packets of 1500 bytes at most between the two. Members are thread-safe.
class Cable {
 public:
  enum class End { One, Other };
  struct Counters {
    std::uint64_t carried = 0;  ///< Duplicates among them.
    std::uint64_t lost = 0;
    std::uint64_t duplicated = 0;
    std::uint64_t overtaken = 0;  ///< Arrived after one that was sent later from the same end.
  };

  /// Ends the program as skipped where the test may not make such devices. The chances are drawn
  /// from `seed`.
  Cable(const NetworkSpace& one, const NetworkSpace& other, std::uint64_t seed);
  ~Cable();
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;

  /// Both directions, for packets that are sent from now on.
  void disturb(const Disturbance& disturbance);
  /// What leaves this end alone.
  void disturb(End from, const Disturbance& disturbance);
  void heal() { disturb({}); }

  Counters counters() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Packet {
    Clock::time_point due;
    std::uint64_t number;
    int from;
    std::vector<char> bytes;
    bool operator>(const Packet& other) const {
      return std::tie(due, number) > std::tie(other.due, other.number);
    }
  };

  void run();
  void receive(int from);
  void deliver(Clock::time_point now);
  bool happens(double share);

  std::array<int, 2> ends_{-1, -1};
  int wake_ = -1;
  mutable std::mutex mutex_;
  std::mt19937_64 random_;
  std::array<Disturbance, 2> disturbances_;
  Counters counters_;
  std::uint64_t last_number_ = 0;
  std::array<std::uint64_t, 2> last_delivered_{};
  std::priority_queue<Packet, std::vector<Packet>, std::greater<>> under_way_;
  std::thread thread_;
};

}  // namespace skein::test
