#pragma once

#include <chrono>
#include <span>

#include "dds/rtps/rtps_guard.hpp"
#include "test/tools/rtps_packet.hpp"

/// A guard on its own, and packets for it.
namespace skein::test::guard_stage {

inline constexpr unsigned kHeartbeat = 0x07;
inline constexpr unsigned kGap = 0x08;
inline constexpr unsigned kData = 0x15;
inline constexpr unsigned kDataFrag = 0x16;
inline constexpr unsigned kPad = 0x01;
inline constexpr std::uint32_t kSomewhere = 10u << 24 | 7;
inline constexpr std::uint32_t kHere = 127u << 24 | 1;

inline Guid writer_of(unsigned number, unsigned char kind = 0x03) {
  Guid guid;
  guid.bytes = {1, 15, 7, 7, 7, 7, 7, 7, 7, 7, 7, 7};
  guid.bytes[13] = static_cast<std::uint8_t>(number >> 8);
  guid.bytes[14] = static_cast<std::uint8_t>(number);
  guid.bytes[15] = kind;
  return guid;
}

inline const Guid kWriter = writer_of(1);
inline const Guid kReader = with_entity(Guid{{9, 9, 9}}, 0x104);

inline std::span<const unsigned char> prefix_of(const Guid& guid) {
  return std::span(guid.bytes).first(12);
}

inline const Octets kPayload{0, 1, 0, 0, 1, 2, 3, 4};
inline const Octets kEndOfList{0x01, 0, 0, 0};

/// A list of parameters, without its end: whose it is.
inline OctetWriter list_of(const Guid& participant) {
  return OctetWriter().u32(0x300).u16(0x50).u16(16).append(
      with_entity(participant, entity_id::kParticipant).bytes);
}

/// And a lease.
inline OctetWriter list_with_lease(const Guid& participant, std::uint32_t seconds = 60) {
  return list_of(participant).u16(0x02).u16(8).u32(seconds).u32(0);
}

inline Guid announcer_of(Guid participant) { return with_entity(participant, 0x100c2); }

inline RtpsPacket from(const Guid& sender, unsigned kind, unsigned flags, const OctetWriter& body,
                       int claimed = -1) {
  return RtpsPacket(sender).submessage(kind, flags, body, claimed);
}

inline RtpsPacket announcement_of(const Guid& participant) {
  const Guid announcer = announcer_of(participant);
  const Octets list = list_with_lease(participant).append(kEndOfList).octets();
  return from(announcer, kData, kHasPayload, data(announcer, 1, list));
}

inline Guid stranger_of(unsigned number) {
  Guid stranger = writer_of(1);
  for (int i = 0; i < 4; ++i) stranger.bytes[8 + i] = static_cast<std::uint8_t>(number >> 8 * i);
  stranger.bytes[5] = 1;
  return stranger;
}

/// A guard on its own, whose time the test tells. It knows `kWriter`, which a reader here is
/// matched with.
struct Stage {
  explicit Stage(dds::SkippedNumbers skipped = dds::SkippedNumbers::Noted,
                 dds::Addresses addresses = {})
      : guard(std::move(addresses), "test", skipped) {
    pass(announcement_of(kWriter).octets(), kHere);
    match(kWriter);
  }

  /// What is handed on.
  Octets pass(Octets message, std::uint32_t source = kSomewhere) {
    message.resize(guard.pass(message.data(), message.size(), source, now).size);
    return message;
  }
  bool passes(const RtpsPacket& packet) { return pass(packet.octets()) == packet.octets(); }
  bool refuses(const RtpsPacket& packet, dds::Refusal why) {
    const auto before = guard.refused(why);
    return pass(packet.octets()).empty() && guard.refused(why) == before + 1;
  }

  bool refuses_stranger(const RtpsPacket& packet) {
    return refuses(packet, dds::Refusal::Stranger);
  }

  void match(const Guid& writer, bool now = true) {
    guard.matched(writer, dds::rtps_message::entity_of(kReader), now);
  }

  /// A fragment of 60,000 bytes, the first, of a sample of that size.
  RtpsPacket begins(const Guid& writer, std::int64_t number, std::uint32_t size) const {
    return from(writer, kDataFrag, 0, data_frag(writer, number, {1, 1, 60'000, size}, 60'000));
  }

  /// A reader here says that it holds a writer's samples up to that one.
  void acknowledge(const Guid& writer, std::int64_t number) {
    const auto acknack = entities(kReader, writer).number(number + 1).u32(0).u32(7);
    Octets message = RtpsPacket(kReader)
                         .submessage(0x0e, 0, OctetWriter().append(prefix_of(writer)))
                         .submessage(0x06, 0, acknack)
                         .octets();
    Guid receiver;
    dds::rtps_message::for_each_submessage(
        message.data(), message.size(),
        [&](const auto& submessage) { guard.sent(submessage, receiver); });
  }

  dds::RtpsGuard guard;
  dds::RtpsGuard::Clock::time_point now{};
};

}  // namespace skein::test::guard_stage
