#include "forgetting.hpp"

#include <cstring>

namespace skein::dds::fastdds {
namespace {

using namespace rtps_message;

constexpr std::size_t kEntityIdSize = 4;

bool is(const unsigned char* entity, const unsigned char* other) {
  return std::memcmp(entity, other, kEntityIdSize) == 0;
}

void raise(std::atomic<std::int64_t>& highest, std::int64_t number) {
  std::int64_t known = highest.load(std::memory_order_relaxed);
  while (known < number && !highest.compare_exchange_weak(known, number)) {
  }
}

/// The participant that a submessage says goes: of the key, or the sender.
std::optional<Guid> leaving(const Submessage& submessage, const Guid& sender) {
  constexpr std::uint16_t kKeyHash = 0x0070;
  constexpr std::uint16_t kStatus = 0x0071;
  if (!is_announcement(submessage) || !submessage.flag(kInlineQos)) return std::nullopt;
  const std::size_t at = 4 + get16(submessage.body() + 2, submessage.little());
  if (at > submessage.size) return std::nullopt;
  Guid participant = sender;
  bool gone = false;
  for_each_parameter(submessage.body() + at, submessage.size - at, submessage.little(),
                     [&](const Parameter& parameter) {
                       if (parameter.id == kKeyHash && parameter.size >= kPrefixSize)
                         std::memcpy(participant.bytes.data(), parameter.value, kPrefixSize);
                       if (parameter.id == kStatus && parameter.size >= 4)
                         gone = parameter.value[3] != 0;
                       return true;
                     });
  return gone ? std::optional(participant) : std::nullopt;
}

/// All up to `last`, as a final ACKNACK that no other one comes after.
unsigned char* append_acknack(unsigned char* at, const unsigned char* reader,
                              const unsigned char* writer, std::int64_t last) {
  constexpr bool kLittle = true;
  constexpr unsigned char kStart[] = {kAckNack, kLittleEndian | kFinal, 24, 0};
  std::memcpy(at, kStart, sizeof kStart);
  std::memcpy(at + 4, reader, kEntityIdSize);
  std::memcpy(at + 8, writer, kEntityIdSize);
  put_sequence_number(at + 12, last + 1, kLittle);
  put32(at + 20, 0, kLittle);
  put32(at + 24, 0xffffffff, kLittle);
  return at + 28;
}

}  // namespace

void SentAnnouncements::note(const Submessage& submessage) {
  // DATA: flags, place of the inline QoS, reader, writer, number. HEARTBEAT: reader, writer,
  // first and last number.
  const bool heartbeat = submessage.kind() == kHeartbeat;
  if (!heartbeat && submessage.kind() != kData) return;
  if (submessage.size < 24 - (heartbeat ? 0u : 4u)) return;
  const unsigned char* writer = submessage.body() + (heartbeat ? 4 : 8);
  const bool writers = is(writer, kWriterAnnouncer);
  if (!writers && !is(writer, kReaderAnnouncer)) return;
  const auto number = get_sequence_number(writer + (heartbeat ? 12 : 4), submessage.little());
  raise(writers ? last_writer_ : last_reader_, number);
}

SentAnnouncements::Acknowledgment SentAnnouncements::acknowledged_by(
    const Guid& participant) const {
  Acknowledgment message{};
  put_header(message.data(), participant);
  unsigned char* at = message.data() + kRtpsHeaderSize;
  at = append_acknack(at, kWriterDetector, kWriterAnnouncer, last_writer_);
  append_acknack(at, kReaderDetector, kReaderAnnouncer, last_reader_);
  return message;
}

void for_each_farewell(unsigned char* message, std::size_t size,
                       const std::function<void(const Guid&)>& visit) {
  for_each_submessage(message, size, [&](const Submessage& submessage) {
    if (const auto participant = leaving(submessage, sender(message))) visit(*participant);
  });
}

}  // namespace skein::dds::fastdds
