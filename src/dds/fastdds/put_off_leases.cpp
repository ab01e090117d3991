#include "put_off_leases.hpp"

#include <cstring>
#include <limits>

#include "dds/rtps/rtps_message.hpp"

namespace skein::dds::fastdds {
namespace {

using namespace rtps_message;

constexpr unsigned char kParticipant[] = {0x00, 0x00, 0x01, 0xc1};

bool put_off(const Parameter& parameter) {
  if (parameter.id != kParticipantLease || parameter.size < 8) return true;
  const std::uint32_t seconds = get32(parameter.value, parameter.little);
  if (seconds < kPutOffSeconds) {
    put32(parameter.value, seconds + kPutOffSeconds, parameter.little);
  }
  return true;
}

}  // namespace

void put_off_leases(unsigned char* message, std::size_t size) {
  for_each_submessage(message, size, [](const Submessage& submessage) {
    if (!is_announcement(submessage) || !submessage.flag(kHasData)) return;
    const auto found = data(submessage);
    if (found) for_each_parameter_of(found->payload, found->payload_size, put_off);
  });
}

std::optional<std::chrono::nanoseconds> announced_lease(std::int32_t seconds,
                                                        std::uint32_t nanoseconds) {
  if (seconds < 0 || seconds == std::numeric_limits<std::int32_t>::max()) return std::nullopt;
  const auto put_off = static_cast<std::int32_t>(kPutOffSeconds);
  return std::chrono::seconds(seconds >= put_off ? seconds - put_off : seconds) +
         std::chrono::nanoseconds(nanoseconds);
}

Farewell make_farewell(const Guid& participant) {
  constexpr unsigned char kDisposal[] = {kData, kLittleEndian | kInlineQos,
                                         52,    0,  // as long as the rest
                                         0,     0,
                                         16,    0};
  // Greater than the number of any announcement: Fast DDS takes none twice, and forgets what it
  // took when the participant goes.
  constexpr unsigned char kNumber[] = {0xff, 0xff, 0xff, 0x7f, 0xfe, 0xff, 0xff, 0xff};
  constexpr unsigned char kKey[] = {0x70, 0, 16, 0};
  constexpr unsigned char kDisposedAndGone[] = {0x71, 0, 4, 0, 0, 0, 0, 3};
  constexpr unsigned char kEnd[] = {0x01, 0, 0, 0};

  Farewell message{};
  put_header(message.data(), participant);
  unsigned char* at = message.data() + kRtpsHeaderSize;
  const auto append = [&](const unsigned char* bytes, std::size_t size) {
    std::memcpy(at, bytes, size);
    at += size;
  };
  append(kDisposal, sizeof kDisposal);
  append(kAnnouncementReader, sizeof kAnnouncementReader);
  append(kAnnouncer, sizeof kAnnouncer);
  append(kNumber, sizeof kNumber);
  append(kKey, sizeof kKey);
  append(participant.bytes.data(), kPrefixSize);
  append(kParticipant, sizeof kParticipant);
  append(kDisposedAndGone, sizeof kDisposedAndGone);
  append(kEnd, sizeof kEnd);
  return message;
}

}  // namespace skein::dds::fastdds
