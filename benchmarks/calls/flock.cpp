#include "calls/flock.hpp"

#include <algorithm>

#include "harness/peer.hpp"

namespace skein::benchmarks {

Flock::Flock(const Configuration& neighbour, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) peers_.emplace_back(neighbour.client);
  for (Child& peer : peers_) {
    // The peer's own patience ends first, and it says what it missed.
    const std::string line = peer.receive(kJoinPatience + Child::kPatience);  // `ready TIME`
    const double joined =
        between_us(peers_.front().started(), line.substr(line.find(' ') + 1));
    joined_us_ = std::max(joined_us_, joined);
  }
}

double Flock::cpu_us() {
  double sum = 0;
  for (Child& peer : peers_) sum += cpu_us_of(peer);
  return sum;
}

}  // namespace skein::benchmarks
