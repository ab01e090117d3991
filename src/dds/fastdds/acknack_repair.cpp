#include "acknack_repair.hpp"

#include <cstring>
#include <string_view>

namespace skein::dds::fastdds {
namespace {

using namespace rtps_message;

/// Where an ACKNACK's set begins: behind the reader's and the writer's entity id.
constexpr std::size_t kSet = 8;

/// Base 0, nothing asked for, an answer wanted. What is left over of the set becomes padding.
void begin_anew(const Submessage& submessage, std::uint32_t count) {
  constexpr std::size_t kEmptySet = 12;
  constexpr std::size_t kSize = kSet + kEmptySet + 4;
  const bool little = submessage.little();
  unsigned char* body = submessage.body();
  submessage.header[1] &= static_cast<unsigned char>(~kFinal);
  put_sequence_number(body + kSet, 0, little);
  put32(body + kSet + 8, 0, little);
  put32(body + kSet + kEmptySet, count, little);
  if (submessage.size == kSize) return;
  put16(submessage.header + 2, kSize, little);
  unsigned char* rest = body + kSize;
  rest[0] = kPad;
  rest[1] = little ? 1 : 0;
  const std::size_t padding = submessage.size - kSize - kSubmessageHeaderSize;
  put16(rest + 2, static_cast<std::uint16_t>(padding), little);
}

}  // namespace

std::size_t AckNackRepair::Hash::operator()(const Endpoints& endpoints) const noexcept {
  return std::hash<std::string_view>()(
      {reinterpret_cast<const char*>(endpoints.data()), endpoints.size()});
}

void AckNackRepair::repair(unsigned char* message, std::size_t size, bool just_returned) {
  constexpr unsigned char kCyclone[] = {0x01, 0x10};
  const bool cyclone = std::memcmp(message + kVendor, kCyclone, sizeof kCyclone) == 0;
  for_each_submessage(message, size, [&](const Submessage& submessage) {
    if (submessage.kind() == kAckNack) {
      repair_submessage(message + kPrefix, submessage, cyclone, cyclone && just_returned);
    }
  });
}

void AckNackRepair::repair_submessage(const unsigned char* sender, const Submessage& submessage,
                                      bool cyclone, bool just_returned) {
  constexpr std::size_t kMany = 65536;  // endpoints that came and went
  const auto set = sequence_number_set(submessage, kSet);
  if (!set) return;
  if (just_returned && set->base > 1) {
    submessage.header[0] = kPad;
    return;
  }
  const bool little = submessage.little();
  unsigned char* body = submessage.body();
  const std::uint32_t said = get32(body + set->end, little);
  Endpoints endpoints;
  std::memcpy(endpoints.data(), sender, kPrefixSize);
  std::memcpy(endpoints.data() + kPrefixSize, body, kSet);

  std::lock_guard lock(mutex_);
  if (progress_.size() > kMany) progress_.clear();
  Progress& progress = progress_[endpoints];
  const bool first_of_cyclone = cyclone && said == 0;
  const bool forgot = set->base < progress.base;
  const bool restarted = forgot && set->base <= 1 && said <= progress.said;
  if (first_of_cyclone || restarted) progress.offset = progress.count + 1;
  const std::uint32_t count = said + progress.offset;
  put32(body + set->end, count, little);
  if (count <= progress.count) return;  // an old one, which Fast DDS passes over
  const bool first = first_of_cyclone && set->bits == 0 && set->base == 1;
  progress = {progress.offset, said, count, set->base};
  if (first || (forgot && set->base > 0)) begin_anew(submessage, count);
}

}  // namespace skein::dds::fastdds
