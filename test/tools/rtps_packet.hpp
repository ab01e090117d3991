#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "skein/guid.hpp"

namespace skein::test {

using Octets = std::vector<unsigned char>;

/// Builds little-endian octets.
class OctetWriter {
 public:
  OctetWriter& u8(unsigned value) { return put(value, 1); }
  OctetWriter& u16(unsigned value) { return put(value, 2); }
  OctetWriter& u32(std::uint32_t value) { return put(value, 4); }
  /// A sequence number: its high half, then its low one.
  OctetWriter& number(std::int64_t value) {
    return u32(static_cast<std::uint32_t>(value >> 32)).u32(static_cast<std::uint32_t>(value));
  }
  OctetWriter& zeros(std::size_t count) {
    octets_.insert(octets_.end(), count, 0);
    return *this;
  }
  OctetWriter& append(std::span<const unsigned char> more) {
    octets_.insert(octets_.end(), more.begin(), more.end());
    return *this;
  }
  const Octets& octets() const { return octets_; }

 private:
  OctetWriter& put(std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) octets_.push_back(static_cast<unsigned char>(value >> (8 * i)));
    return *this;
  }
  Octets octets_;
};

/// An RTPS message that a test makes as it likes.
class RtpsPacket {
 public:
  /// From eProsima's vendor, with that GUID's prefix.
  explicit RtpsPacket(const Guid& sender) {
    message_.append(std::initializer_list<unsigned char>{'R', 'T', 'P', 'S', 2, 3, 1, 15});
    message_.append(std::span(sender.bytes).first(12));
  }

  /// Little-endian, with `flags` beside, and its true length unless another is claimed.
  RtpsPacket& submessage(unsigned kind, unsigned flags, const OctetWriter& body,
                         int claimed_length = -1) {
    const auto length = claimed_length < 0 ? body.octets().size() : std::size_t(claimed_length);
    message_.u8(kind).u8(flags | 1).u16(static_cast<unsigned>(length)).append(body.octets());
    return *this;
  }
  RtpsPacket& append(const OctetWriter& more) {
    message_.append(more.octets());
    return *this;
  }

  const Octets& octets() const { return message_.octets(); }

 private:
  OctetWriter message_;
};

/// Entity ids of RTPS 9.3.1.5.
namespace entity_id {
inline constexpr std::uint32_t kParticipant = 0x1c1;
inline constexpr std::uint32_t kParticipantAnnouncer = 0x100c2;
inline constexpr std::uint32_t kParticipantDetector = 0x100c7;
inline constexpr std::uint32_t kPublicationsAnnouncer = 0x3c2;
inline constexpr std::uint32_t kPublicationsDetector = 0x3c7;
inline constexpr std::uint32_t kSubscriptionsAnnouncer = 0x4c2;
inline constexpr std::uint32_t kSubscriptionsDetector = 0x4c7;
}  // namespace entity_id

/// An endpoint of the participant to which a GUID belongs.
inline Guid with_entity(Guid guid, std::uint32_t entity) {
  for (int i = 0; i < 4; ++i) guid.bytes[15 - i] = static_cast<std::uint8_t>(entity >> (8 * i));
  return guid;
}

/// The reader to which a submessage speaks, or nobody in particular, and its writer: entity ids.
inline OctetWriter entities(const Guid& reader, const Guid& writer) {
  return OctetWriter()
      .append(std::span(reader.bytes).subspan(12))
      .append(std::span(writer.bytes).subspan(12));
}

inline OctetWriter heartbeat(const Guid& writer, std::int64_t first, std::int64_t last,
                             std::uint32_t count = 1, const Guid& reader = {}) {
  return entities(reader, writer).number(first).number(last).u32(count);
}

/// From `start` to before `base`, and no more.
inline OctetWriter gap(const Guid& writer, std::int64_t start, std::int64_t base,
                       const Guid& reader = {}) {
  return entities(reader, writer).number(start).number(base).u32(0);
}

inline OctetWriter data(const Guid& writer, std::int64_t number,
                        std::span<const unsigned char> payload, const Guid& reader = {}) {
  return OctetWriter()
      .u16(0)
      .u16(16)
      .append(entities(reader, writer).octets())
      .number(number)
      .append(payload);
}

struct FragmentClaim {
  std::uint32_t first = 1;
  unsigned count = 1;
  unsigned size = 1024;
  std::uint32_t sample_size = 4096;
};

inline OctetWriter data_frag(const Guid& writer, std::int64_t number, const FragmentClaim& claim,
                             std::size_t payload, const Guid& reader = {}) {
  return OctetWriter()
      .u16(0)
      .u16(28)
      .append(entities(reader, writer).octets())
      .number(number)
      .u32(claim.first)
      .u16(claim.count)
      .u16(claim.size)
      .u32(claim.sample_size)
      .zeros(payload);
}

/// Flags: the latter for `data_frag` and `data`.
inline constexpr unsigned kHasInlineQos = 0x02;
inline constexpr unsigned kHasPayload = 0x04;

/// A participant's word that it has gone: the disposal of its announcement.
inline RtpsPacket farewell(const Guid& participant, std::int64_t number) {
  using namespace entity_id;
  const OctetWriter qos = OctetWriter()
                              .u16(0x70)  // whose
                              .u16(16)
                              .append(with_entity(participant, kParticipant).bytes)
                              .u16(0x71)  // disposed and unregistered
                              .u16(4)
                              .u32(3u << 24)
                              .u16(1)  // the list's end
                              .u16(0);
  return RtpsPacket(participant)
      .submessage(0x15, kHasInlineQos,
                  data(with_entity(participant, kParticipantAnnouncer), number, qos.octets(),
                       with_entity(participant, kParticipantDetector)));
}

}  // namespace skein::test
