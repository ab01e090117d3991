#pragma once

#include <string>

#include "rtps_packet.hpp"

namespace skein::test {

/// A participant that exists in its packets alone: what it says is well formed, and true of itself.
class InventedPeer {
 public:
  /// Where it says that it receives discovery, and samples at the next one. Nobody answers.
  static constexpr std::uint16_t kPort = 9;

  /// Each number is another participant, whose packets come from `address` (IPv4, in host order).
  explicit InventedPeer(std::uint32_t number, std::uint32_t address = 127u << 24 | 1)
      : address_(address) {
    guid_.bytes = {1, 15, 0xee, 0xee};
    for (int i = 0; i < 4; ++i) {
      guid_.bytes[8 + i] = static_cast<std::uint8_t>(number >> (8 * (3 - i)));
    }
  }

  Guid entity(std::uint32_t id) const { return with_entity(guid_, id); }
  Guid writer(std::uint32_t number) const { return entity(number << 8 | 0x03); }
  Guid reader(std::uint32_t number) const { return entity(number << 8 | 0x04); }

  /// Its announcement; `seconds` is its lease.
  RtpsPacket announcement(std::uint32_t seconds = 60) const {
    using namespace entity_id;
    // 0x3f: it announces and detects participants, writers and readers.
    const OctetWriter list =
        OctetWriter()
            .append(kList)
            .append(parameter(0x15, OctetWriter().u8(2).u8(3).u16(0)))
            .append(parameter(0x16, OctetWriter().u8(1).u8(15).u16(0)))
            .append(parameter(0x50, OctetWriter().append(entity(kParticipant).bytes)))
            .append(parameter(0x32, locator(kPort)))
            .append(parameter(0x31, locator(kPort + 1)))
            .append(parameter(0x02, OctetWriter().u32(seconds).u32(0)))
            .append(parameter(0x58, OctetWriter().u32(0x3f)))
            .append(kEnd);
    return RtpsPacket(guid_).submessage(0x15, kHasPayload,
                                        data(entity(kParticipantAnnouncer), 1, list.octets()));
  }

  /// What it says of a reliable endpoint, in the default partition: the `number`th such message.
  /// With user data of that size, a multiple of 4.
  RtpsPacket endpoint(const Guid& whose, const std::string& topic, const std::string& type,
                      std::int64_t number, std::size_t user_data = 0) const {
    const OctetWriter list =
        OctetWriter()
            .append(kList)
            .append(parameter(0x5a, OctetWriter().append(whose.bytes)))
            .append(parameter(0x05, text(topic)))
            .append(parameter(0x07, text(type)))
            .append(parameter(0x1a, OctetWriter().u32(2).u32(0).u32(100'000'000)))
            .append(parameter(
                0x2c, OctetWriter().u32(static_cast<std::uint32_t>(user_data)).zeros(user_data)))
            .append(kEnd);
    return heartbeat_of(announcer_of(whose), number)
        .submessage(0x15, kHasPayload, data(announcer_of(whose), number, list.octets()));
  }

  /// And that there is no such endpoint any more.
  RtpsPacket withdrawal(const Guid& whose, std::int64_t number) const {
    const OctetWriter qos = OctetWriter()
                                .append(parameter(0x70, OctetWriter().append(whose.bytes)))
                                .append(parameter(0x71, OctetWriter().u32(3u << 24)))
                                .append(kEnd);
    return heartbeat_of(announcer_of(whose), number)
        .submessage(0x15, kHasInlineQos, data(announcer_of(whose), number, qos.octets()));
  }

  RtpsPacket says(unsigned kind, const OctetWriter& body, unsigned flags = 0) const {
    return RtpsPacket(guid_).submessage(kind, flags, body);
  }

  /// The writer that announces endpoints of that one's side.
  Guid announcer_of(const Guid& endpoint) const {
    using namespace entity_id;
    const bool reads = (endpoint.bytes[15] & 0x07) == 0x04 || (endpoint.bytes[15] & 0x07) == 0x07;
    return entity(reads ? kSubscriptionsAnnouncer : kPublicationsAnnouncer);
  }

  OctetWriter locator(std::uint16_t port) const {
    OctetWriter result = OctetWriter().u32(1).u32(port).zeros(12);
    for (int shift = 24; shift >= 0; shift -= 8) result.u8(address_ >> shift & 0xff);
    return result;
  }

  static Octets parameter(unsigned id, const OctetWriter& value) {
    return OctetWriter()
        .u16(id)
        .u16(static_cast<unsigned>(value.octets().size()))
        .append(value.octets())
        .octets();
  }

  static OctetWriter text(const std::string& value) {
    OctetWriter result = OctetWriter().u32(static_cast<std::uint32_t>(value.size() + 1));
    for (const char letter : value) result.u8(static_cast<unsigned char>(letter));
    return result.zeros(4 - value.size() % 4);
  }

 private:
  /// Cyclone takes nothing of a writer that it has not heard one of.
  RtpsPacket heartbeat_of(const Guid& writer, std::int64_t last) const {
    return RtpsPacket(guid_).submessage(
        0x07, 0, heartbeat(writer, 1, last, static_cast<std::uint32_t>(last)));
  }

  static constexpr unsigned char kList[] = {0, 3, 0, 0};
  static constexpr unsigned char kEnd[] = {1, 0, 0, 0};
  Guid guid_;
  std::uint32_t address_;
};

}  // namespace skein::test
