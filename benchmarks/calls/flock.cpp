#include "calls/flock.hpp"

#include <algorithm>

#include "harness/peer.hpp"

namespace skein::benchmarks {

Flock::Flock(const Configuration& neighbour, std::size_t count) {
  try {
    for (std::size_t i = 0; i < count; ++i) peers_.emplace_back(neighbour.client);
    for (Child& peer : peers_) await(peer);
  } catch (...) {
    end();
    throw;
  }
}

Flock::~Flock() { end(); }

void Flock::await(Child& peer) {
  // The peer's own patience ends first, and it says what it missed.
  const std::string line = peer.receive(kJoinPatience + Child::kPatience);  // `ready TIME`
  joined_us_ =
      std::max(joined_us_, between_us(peers_.front().started(), line.substr(line.find(' ') + 1)));
}

// One by one they would tell all others of their leaving, and peers that still wait obey nothing.
void Flock::end() noexcept {
  for (Child& peer : peers_) peer.kill();
}

double Flock::cpu_us() {
  double sum = 0;
  for (Child& peer : peers_) sum += cpu_us_of(peer);
  return sum;
}

}  // namespace skein::benchmarks
