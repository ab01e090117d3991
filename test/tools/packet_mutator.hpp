#pragma once

#include <random>

#include "rtps_packet.hpp"

namespace skein::test {

/// Draws RTPS messages that are almost good: those it is given, changed in their bits, numbers,
/// lengths and kinds, cut off, lengthened, and put together anew from one another's submessages.
/// The same seed and packets give the same ones.
class PacketMutator {
 public:
  PacketMutator(std::vector<Octets> packets, std::uint64_t seed)
      : packets_(std::move(packets)), random_(seed) {}

  Octets next();

 private:
  std::size_t below(std::size_t limit) { return random_() % limit; }
  void mutate(Octets& packet);
  void mutate_submessage(Octets& packet);
  Octets random_submessage(const Octets& packet);

  std::vector<Octets> packets_;
  std::mt19937_64 random_;
};

}  // namespace skein::test
