#include "packet_mutator.hpp"

namespace skein::test {
namespace {

constexpr std::size_t kHeader = 20;
constexpr std::size_t kLargest = 65'000;
constexpr std::uint32_t kNumbers[] = {
    0,       1,       2,        3,          4,          7,          8,         16,     255,
    256,     257,     1023,     1024,       1500,       4096,       0x7fff,    0x8000, 0xffff,
    0x10000, 0xfffff, 0x100000, 0x7fffffff, 0x80000000, 0xfffffff0, 0xffffffff};
constexpr unsigned char kKinds[] = {0x01, 0x02, 0x06, 0x07, 0x08, 0x09, 0x0c,
                                    0x0d, 0x0e, 0x0f, 0x12, 0x13, 0x15, 0x16,
                                    0x30, 0x31, 0x33, 0x80, 0x81, 0x82, 0xff};

void put32(Octets& packet, std::size_t at, std::uint32_t value, bool little) {
  for (std::size_t i = 0; i < 4 && at + i < packet.size(); ++i) {
    packet[at + i] = static_cast<unsigned char>(value >> (8 * (little ? i : 3 - i)));
  }
}

/// Where the submessages begin, as far as their lengths tell.
std::vector<std::size_t> starts(const Octets& packet) {
  std::vector<std::size_t> found;
  for (std::size_t at = kHeader; at + 4 <= packet.size();) {
    found.push_back(at);
    const bool little = (packet[at + 1] & 1) != 0;
    const std::size_t length =
        little ? packet[at + 2] | packet[at + 3] << 8 : packet[at + 3] | packet[at + 2] << 8;
    at += 4 + length;
  }
  return found;
}

}  // namespace

Octets PacketMutator::next() {
  Octets packet = packets_[below(packets_.size())];
  for (std::size_t i = 0, count = 1 + below(4); i < count; ++i) mutate(packet);
  if (packet.size() > kLargest) packet.resize(kLargest);
  return packet;
}

void PacketMutator::mutate(Octets& packet) {
  if (packet.size() <= kHeader) return;
  // The header's own fields are seldom worth it.
  const std::size_t at =
      below(20) == 0 ? below(packet.size()) : kHeader + below(packet.size() - kHeader);
  const std::size_t aligned = at / 4 * 4;
  const bool little = below(2) == 0;
  const std::uint32_t number = kNumbers[below(std::size(kNumbers))];
  switch (below(10)) {
    case 0:
    case 1:
      packet[at] ^= static_cast<unsigned char>(1 << below(8));
      return;
    case 2:
      packet[at] = static_cast<unsigned char>(random_());
      return;
    case 3:
      return put32(packet, aligned, number, little);
    case 4:  // a sequence number
      put32(packet, aligned, below(4) == 0 ? number : 0, little);
      return put32(packet, aligned + 4, number, little);
    case 5:
      packet.resize(at);
      return;
    case 6:
      for (std::size_t i = below(64); i > 0; --i) {
        packet.push_back(static_cast<unsigned char>(random_()));
      }
      return;
    default:
      return mutate_submessage(packet);
  }
}

void PacketMutator::mutate_submessage(Octets& packet) {
  const auto submessages = starts(packet);
  if (submessages.empty()) return;
  const std::size_t at = submessages[below(submessages.size())];
  switch (below(6)) {
    case 0: {  // its length
      const auto length = below(2) == 0 ? kNumbers[below(std::size(kNumbers))] : random_() % 128;
      packet[at + 2] = static_cast<unsigned char>(length);
      packet[at + 3] = static_cast<unsigned char>(length >> 8);
      return;
    }
    case 1:
      packet[at] = kKinds[below(std::size(kKinds))];
      return;
    case 2:
      packet[at + 1] ^= static_cast<unsigned char>(1 << below(5));
      return;
    case 3:
      packet.erase(packet.begin() + static_cast<std::ptrdiff_t>(kHeader),
                   packet.begin() + static_cast<std::ptrdiff_t>(at));
      return;
    default: {
      const Octets more = random_submessage(packets_[below(packets_.size())]);
      packet.insert(packet.end(), more.begin(), more.end());
    }
  }
}

Octets PacketMutator::random_submessage(const Octets& packet) {
  const auto submessages = starts(packet);
  if (submessages.empty()) return {};
  const std::size_t chosen = below(submessages.size());
  const auto begin = packet.begin() + static_cast<std::ptrdiff_t>(submessages[chosen]);
  if (chosen + 1 == submessages.size()) return {begin, packet.end()};
  return {begin, packet.begin() + static_cast<std::ptrdiff_t>(submessages[chosen + 1])};
}

}  // namespace skein::test
