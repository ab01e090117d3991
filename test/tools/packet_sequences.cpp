#include "packet_sequences.hpp"

#include <algorithm>

namespace skein::test {
namespace {

constexpr unsigned kAckNack = 0x06;
constexpr unsigned kHeartbeat = 0x07;
constexpr unsigned kGap = 0x08;
constexpr unsigned kNackFrag = 0x12;
constexpr unsigned kHeartbeatFrag = 0x13;
constexpr unsigned kData = 0x15;
constexpr unsigned kDataFrag = 0x16;

}  // namespace

RtpsPacket PacketSequences::next() {
  if (peers_.size() < kPeers && (peers_.empty() || one_in(40))) {
    peers_.push_back({InventedPeer(static_cast<std::uint32_t>(1 + peers_.size()))});
  }
  Peer& peer = peers_[below(peers_.size())];
  if (!peer.announced || one_in(100)) {
    constexpr std::uint32_t kLeases[] = {0, 1, 10, 60, 0x7fffffff};
    peer.announced = true;
    return peer.self.announcement(kLeases[below(std::size(kLeases))]);
  }
  if (one_in(400)) {
    Peer left = std::move(peer);
    peer = {left.self};
    return farewell(left.self.entity(entity_id::kParticipant), 2);
  }
  switch (below(8)) {
    case 0:
      return speak_of_endpoint(peer);
    case 1:
      return acknowledge(peer);
    default:
      return speak_of_samples(peer);
  }
}

/// Mostly the next one, or one close by; sometimes one that nobody has reached.
std::int64_t PacketSequences::near(std::int64_t number) {
  switch (below(12)) {
    case 0:
      return std::int64_t{1} << below(34);
    case 1:
      return number + static_cast<std::int64_t>(below(70'000));
    case 2:
      return std::max<std::int64_t>(1, number - static_cast<std::int64_t>(below(300)));
    case 3:
      return number + 2 + static_cast<std::int64_t>(below(300));
    default:
      return number + 1;
  }
}

RtpsPacket PacketSequences::speak_of_endpoint(Peer& peer) {
  const Topic& topic = topics_[below(topics_.size())];
  const auto which = static_cast<std::uint32_t>(1 + below(peer.samples.size()));
  const Guid whose = topic.written ? peer.self.reader(which) : peer.self.writer(which);
  const std::int64_t number = ++(topic.written ? peer.readers : peer.writers);
  if (one_in(6)) return peer.self.withdrawal(whose, number);
  return peer.self.endpoint(whose, topic.name, topic.type, number);
}

RtpsPacket PacketSequences::speak_of_samples(Peer& peer) {
  const std::size_t which = below(peer.samples.size());
  Guid writer = peer.self.writer(static_cast<std::uint32_t>(1 + which));
  std::int64_t* last = &peer.samples[which];
  std::int64_t others = static_cast<std::int64_t>(below(100));
  if (one_in(8)) {
    writer = peer.self.entity(one_in(2) ? entity_id::kPublicationsAnnouncer : 0x200c2);
    last = &others;
  }
  const std::int64_t number = near(*last);
  switch (below(6)) {
    case 0: {
      const std::int64_t first = one_in(3) ? number : 1 + static_cast<std::int64_t>(below(8));
      const std::int64_t to = std::max(first - 1, one_in(3) ? near(number) : number);
      *last = std::max(*last, std::min(to, *last + 100'000));
      return peer.self.says(kHeartbeat, heartbeat(writer, first, to, ++peer.count),
                            one_in(2) ? 0x02 : 0);
    }
    case 1: {
      const std::int64_t base = number + static_cast<std::int64_t>(below(one_in(4) ? 70'000 : 300));
      *last = std::max(*last, std::min(base, *last + 100'000));
      return peer.self.says(kGap, gap(writer, number, base));
    }
    case 2:
    case 3: {
      Octets payload{0, 1, 0, 0};
      for (std::size_t i = below(one_in(10) ? 8000 : 120) / 4 * 4; i > 0; --i) {
        payload.push_back(static_cast<unsigned char>(random_()));
      }
      *last = std::max(*last, std::min(number, *last + 100'000));
      return peer.self.says(kData, data(writer, number, payload), kHasPayload);
    }
    default:
      return send_fragments(peer, writer, *last);
  }
}

RtpsPacket PacketSequences::send_fragments(Peer& peer, const Guid& writer, std::int64_t& last) {
  constexpr std::uint32_t kSizes[] = {2000, 9000, 300'000, 1u << 20, 20u << 20, 256u << 20};
  // The same number again: another fragment of that sample, which may contradict the first.
  const std::int64_t number = one_in(3) ? near(last) : std::max<std::int64_t>(1, last);
  last = std::max(last, std::min(number, last + 100'000));
  FragmentClaim claim;
  claim.size = one_in(3) ? 256 : 1024;
  claim.sample_size = kSizes[one_in(4) ? below(std::size(kSizes)) : number % 3];
  const std::uint32_t all = (claim.sample_size + claim.size - 1) / claim.size;
  claim.first = static_cast<std::uint32_t>(1 + below(one_in(2) ? std::min(all, 4u) : all));
  if (one_in(10)) {
    return peer.self.says(kHeartbeatFrag,
                          entities({}, writer).number(number).u32(claim.first).u32(++peer.count));
  }
  return peer.self.says(kDataFrag, data_frag(writer, number, claim, claim.size));
}

RtpsPacket PacketSequences::acknowledge(Peer& peer) {
  const auto which = static_cast<std::uint32_t>(1 + below(peer.samples.size()));
  Guid reader = peer.self.reader(which);
  Guid writer = with_entity({}, static_cast<std::uint32_t>(below(40)) << 8 | 0x03);
  if (one_in(2)) {
    const bool publications = one_in(2);
    reader = peer.self.entity(publications ? entity_id::kPublicationsDetector
                                           : entity_id::kSubscriptionsDetector);
    writer = with_entity(
        {}, publications ? entity_id::kPublicationsAnnouncer : entity_id::kSubscriptionsAnnouncer);
  }
  const std::int64_t base = near(static_cast<std::int64_t>(below(40)));
  const auto bits = static_cast<std::uint32_t>(below(256));
  OctetWriter set = entities(reader, writer);
  if (one_in(5)) {
    set.number(base).u32(1).u32(bits);
  } else {
    set.number(base).u32(bits);
  }
  const bool fragments = set.octets().size() == 8 + 8 + 4 + 4;
  for (std::uint32_t i = 0; i < (bits + 31) / 32; ++i) {
    set.u32(static_cast<std::uint32_t>(random_()));
  }
  return peer.self.says(fragments ? kNackFrag : kAckNack, set.u32(++peer.count));
}

}  // namespace skein::test
