#pragma once

#include <array>
#include <random>
#include <vector>

#include "invented_peer.hpp"

namespace skein::test {

/// Draws what invented participants say, packet by packet: each is well formed, and most of them
/// follow from those before. They come and go, announce and withdraw endpoints, some of which match
/// the other side's, and speak of samples, gaps, fragments and acknowledgments, near to what they
/// have said and far from it. The same seed gives the same ones.
class PacketSequences {
 public:
  struct Topic {
    std::string name;
    std::string type;
    bool written;  ///< By the other side; else it reads it.
  };

  PacketSequences(std::vector<Topic> topics, std::uint64_t seed)
      : topics_(std::move(topics)), random_(seed) {}

  RtpsPacket next();

 private:
  struct Peer {
    InventedPeer self;
    bool announced = false;
    std::int64_t readers = 0;  // messages about endpoints so far
    std::int64_t writers = 0;
    std::array<std::int64_t, 6> samples{};  // of each of its writers
    std::uint32_t count = 0;                // of heartbeats and acknowledgments
  };

  std::size_t below(std::size_t limit) { return random_() % limit; }
  bool one_in(std::size_t many) { return below(many) == 0; }
  std::int64_t near(std::int64_t number);
  RtpsPacket speak_of_endpoint(Peer& peer);
  RtpsPacket speak_of_samples(Peer& peer);
  RtpsPacket send_fragments(Peer& peer, const Guid& writer, std::int64_t& last);
  RtpsPacket acknowledge(Peer& peer);

  static constexpr std::uint32_t kPeers = 48;

  const std::vector<Topic> topics_;
  std::mt19937_64 random_;
  std::vector<Peer> peers_;
};

}  // namespace skein::test
