#include "announced_representation.hpp"

namespace skein::dds::fastdds {
namespace {

using namespace rtps_message;

constexpr std::uint16_t kPresentation = 0x0021;
constexpr std::uint32_t kTopicScope = 1;
constexpr std::uint16_t kRepresentation = 0x0073;
constexpr std::uint16_t kXcdr2 = 2;

bool is_from(const Data& data, const unsigned char (&writer)[4]) {
  return std::memcmp(data.writer, writer, sizeof writer) == 0;
}

bool replace_mark(const Parameter& parameter) {
  if (parameter.id != kPresentation || parameter.size != 8) return true;
  if (get32(parameter.value, parameter.little) != kTopicScope) return true;
  put16(parameter.header, kRepresentation, parameter.little);
  put32(parameter.value, 1, parameter.little);  // how many follow
  put16(parameter.value + 4, kXcdr2, parameter.little);
  put16(parameter.value + 6, 0, parameter.little);
  return true;
}

}  // namespace

void announce_representation(const Submessage& submessage) {
  if (submessage.kind() != kData || !submessage.flag(kHasData)) return;
  const auto found = data(submessage);
  if (!found || (!is_from(*found, kWriterAnnouncer) && !is_from(*found, kReaderAnnouncer))) return;
  for_each_parameter_of(found->payload, found->payload_size, replace_mark);
}

}  // namespace skein::dds::fastdds
