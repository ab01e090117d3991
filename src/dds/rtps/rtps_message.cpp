#include "rtps_message.hpp"

#include <algorithm>
#include <limits>

namespace skein::dds::rtps_message {
namespace {

constexpr std::uint32_t kMaxBits = 256;
constexpr std::int64_t kLastNumber = std::numeric_limits<std::int64_t>::max() - kMaxBits;

std::optional<NumberSet> with_bits(NumberSet set, const Submessage& submessage, std::size_t at) {
  set.bits = get32(submessage.body() + at, submessage.little());
  if (set.bits > kMaxBits) return std::nullopt;
  set.end = at + 4 + (set.bits + 31) / 32 * 4;
  return set.end <= submessage.size ? std::optional(set) : std::nullopt;
}

/// With the zero at its end: of a topic, a type or a partition. Vendors have fixed room for them.
constexpr std::size_t kLongestName = 256;

/// A parameter's value that is read from front to back.
struct Value {
  const unsigned char* at;
  std::size_t left;
  bool little;

  bool skip(std::size_t count) {
    if (count > left) return false;
    at += count;
    left -= count;
    return true;
  }
  std::optional<std::uint32_t> number() {
    const unsigned char* place = at;
    if (!skip(4)) return std::nullopt;
    return get32(place, little);
  }
  /// Ends with a zero, as CDR's strings do; vendors rely on it.
  bool text(std::size_t longest = SIZE_MAX) {
    const auto length = number();
    if (!length || *length == 0 || *length > left || at[*length - 1] != 0) return false;
    return *length <= longest && skip(std::min(left, (std::size_t{*length} + 3) / 4 * 4));
  }
  bool texts(std::uint32_t each = 1, std::size_t longest = SIZE_MAX) {
    const auto count = number();
    if (!count || *count > left / 4) return false;
    for (std::uint32_t i = 0; i < *count * each; ++i) {
      if (!text(longest)) return false;
    }
    return true;
  }
  /// A sequence of elements of that size.
  bool sequence(std::size_t element) {
    const auto count = number();
    return count && *count <= left / element;
  }
};

bool check_parameter(const Parameter& parameter) {
  Value value{parameter.value, parameter.size, parameter.little};
  switch (parameter.id) {
    case 0x0005:  // topic name
    case 0x0007:  // type name
      return value.text(kLongestName);
    case 0x0062:  // entity name
    case 0x4014:  // domain tag
      return value.text();
    case 0x0029:  // partitions
      return value.texts(1, kLongestName);
    case 0x0059:  // properties
      return value.texts(2);
    case 0x0035:  // content filter
      return value.text() && value.text() && value.text() && value.text() && value.texts();
    case 0x002c:  // user, group and topic data
    case 0x002d:
    case 0x002e:
      return value.sequence(1);
    case 0x0073:  // data representations
      return value.sequence(2);
    case 0x002f:  // locators
    case 0x0030:
    case 0x0031:
    case 0x0032:
    case 0x0033:
    case 0x0048:
      return parameter.size == 24;
    case kParticipantLease:
      return parameter.size == 8 &&
             get32(parameter.value, parameter.little) <= std::numeric_limits<std::int32_t>::max();
    case 0x000b:  // addresses and ports in the form of RTPS 1, which Cyclone still reads
    case 0x000c:
    case 0x000d:
    case 0x000e:
    case 0x0011:
    case 0x0045:
    case 0x0046:
    case 0x0069:  // descriptions of types
    case 0x0072:
    case 0x0075:
    case 0x8006:  // shared memory
    case 0x1001:  // security's tokens
    case 0x1002:
    case 0x1003:
    case 0x1004:
    case 0x1005:
    case 0x1006:
      parameter.header[0] = parameter.header[1] = 0;  // padding
      return true;
    default:
      return true;
  }
}

bool is_locator(std::uint16_t id) { return (id >= 0x002f && id <= 0x0033) || id == 0x0048; }

/// Its value: kind, port, and 16 bytes of an address, whose last four are IPv4's.
bool may_keep(const Parameter& locator, const std::function<bool(std::uint32_t)>& may_name) {
  constexpr std::uint32_t kUdp4 = 1;
  constexpr std::uint32_t kSharedMemory2 =
      16;  // of Fast DDS 2, and of 3, which pass over the other
  constexpr std::uint32_t kSharedMemory3 = 19;
  constexpr std::uint32_t kGroup = 239u << 24 | 255 << 16 | 1;  // 239.255.0.1, RTPS 9.6.1.4
  const std::uint32_t kind = get32(locator.value, locator.little);
  if (kind == kSharedMemory2 || kind == kSharedMemory3) return true;
  const std::uint32_t address = get32(locator.value + 20, false);
  return kind == kUdp4 && (address == kGroup || may_name(address));
}

/// Where inline QoS or payload begin, and the parts of the header that both kinds share.
std::optional<Data> data_header(const Submessage& submessage, std::size_t fixed) {
  unsigned char* body = submessage.body();
  if (submessage.size < fixed) return std::nullopt;
  const std::size_t skipped = get16(body + 2, submessage.little());
  if (skipped < fixed - 4 || skipped % 4 != 0 || 4 + skipped > submessage.size) return std::nullopt;
  Data result;
  result.writer = body + 8;
  result.number = get_sequence_number(body + 12, submessage.little());
  if (result.number < 1 || result.number > kLastNumber) return std::nullopt;
  result.payload = body + 4 + skipped;
  result.payload_size = submessage.size - 4 - skipped;
  if (!submessage.flag(kInlineQos)) return result;
  const auto qos = for_each_parameter(result.payload, result.payload_size, submessage.little(),
                                      [](const Parameter&) { return true; });
  if (!qos) return std::nullopt;
  result.payload += *qos;
  result.payload_size -= *qos;
  return result;
}

}  // namespace

std::optional<NumberSet> sequence_number_set(const Submessage& submessage, std::size_t at) {
  if (submessage.size < at + 12) return std::nullopt;
  const auto set = with_bits({get_sequence_number(submessage.body() + at, submessage.little())},
                             submessage, at + 8);
  if (!set || set->base < (set->bits == 0 ? 0 : 1) || set->base > kLastNumber) return std::nullopt;
  return set;
}

std::optional<NumberSet> fragment_number_set(const Submessage& submessage, std::size_t at) {
  if (submessage.size < at + 8) return std::nullopt;
  const auto set =
      with_bits({get32(submessage.body() + at, submessage.little())}, submessage, at + 4);
  if (!set || set->base < 1) return std::nullopt;
  return set->base <= std::numeric_limits<std::uint32_t>::max() - kMaxBits ? set : std::nullopt;
}

std::optional<Data> data(const Submessage& submessage) {
  constexpr std::size_t kFixed = 20;
  constexpr std::size_t kEncapsulation = 4;
  const bool has_data = submessage.flag(kHasData);
  const bool has_key = submessage.flag(kHasKey);
  if (has_data && has_key) return std::nullopt;
  const auto result = data_header(submessage, kFixed);
  if (result && (has_data || has_key) && result->payload_size < kEncapsulation) {
    return std::nullopt;
  }
  return result;
}

std::optional<Data> data_frag(const Submessage& submessage, Fragments& fragments) {
  constexpr std::size_t kFixed = 32;
  if (submessage.flag(0x04)) return std::nullopt;  // of a key alone: nobody's keys are so large
  const auto result = data_header(submessage, kFixed);
  if (!result) return std::nullopt;
  const unsigned char* body = submessage.body();
  const bool little = submessage.little();
  fragments = {get32(body + 20, little), get16(body + 24, little), get16(body + 26, little),
               get32(body + 28, little)};
  if (fragments.first < 1 || fragments.count < 1 || fragments.size < 1) return std::nullopt;
  if (fragments.sample_size < 1 ||
      fragments.sample_size > std::numeric_limits<std::uint32_t>::max() - fragments.size) {
    return std::nullopt;
  }
  const std::uint64_t before = std::uint64_t{fragments.first} - 1;
  if (before + fragments.count > fragments.in_sample()) return std::nullopt;
  const std::uint64_t all = std::uint64_t{fragments.count} * fragments.size;
  const std::uint64_t rest = fragments.sample_size - before * fragments.size;
  return result->payload_size >= std::min(all, rest) ? result : std::nullopt;
}

bool check_discovery(unsigned char* payload, std::size_t size) {
  return for_each_parameter_of(payload, size, check_parameter).has_value();
}

bool is_of_sender(const Submessage& submessage, const unsigned char* prefix) {
  bool named = false;
  const auto is_own = [&](const Parameter& parameter) {
    if (parameter.id != kParticipantGuid && parameter.id != kEndpointGuid &&
        parameter.id != kKeyHash) {
      return true;
    }
    named = true;
    return parameter.size >= kPrefixSize && std::memcmp(parameter.value, prefix, kPrefixSize) == 0;
  };
  const auto found = data(submessage);
  if (!found) return false;
  if (submessage.flag(kInlineQos)) {
    const std::size_t at = 4 + get16(submessage.body() + 2, submessage.little());
    if (!for_each_parameter(submessage.body() + at, submessage.size - at, submessage.little(),
                            is_own)) {
      return false;
    }
  }
  if (submessage.flag(kHasData) || submessage.flag(kHasKey)) {
    if (!for_each_parameter_of(found->payload, found->payload_size, is_own)) return false;
  }
  return named;
}

std::optional<std::uint32_t> announced_entity(unsigned char* payload, std::size_t size) {
  std::optional<std::uint32_t> participant;
  std::optional<std::uint32_t> endpoint;
  bool several = false;
  for_each_parameter_of(payload, size, [&](const Parameter& parameter) {
    const bool is_endpoint = parameter.id == kEndpointGuid || parameter.id == kKeyHash;
    if (!is_endpoint && parameter.id != kParticipantGuid) return true;
    if (parameter.size < 16) return several = true;
    const std::uint32_t named = get32(parameter.value + kPrefixSize, false);
    auto& known = is_endpoint ? endpoint : participant;
    several |= known && *known != named;
    known = named;
    return true;
  });
  if (several) return std::nullopt;
  return endpoint ? endpoint : participant;
}

bool names_lease(unsigned char* payload, std::size_t size, std::uint32_t longest_s) {
  bool found = false;
  for_each_parameter_of(payload, size, [&](const Parameter& parameter) {
    if (parameter.id != kParticipantLease) return true;
    found = true;
    if (get32(parameter.value, parameter.little) >= longest_s) {
      put32(parameter.value, longest_s, parameter.little);
      put32(parameter.value + 4, 0, parameter.little);
    }
    return true;
  });
  return found;
}

bool keep_locators(unsigned char* payload, std::size_t size,
                   const std::function<bool(std::uint32_t)>& may_name) {
  constexpr std::uint16_t kOfDiscovery = 0x0032;
  int named = 0;
  int kept = 0;
  for_each_parameter_of(payload, size, [&](const Parameter& parameter) {
    if (!is_locator(parameter.id)) return true;
    const bool keep = may_keep(parameter, may_name);
    if (!keep) parameter.header[0] = parameter.header[1] = 0;  // padding
    if (parameter.id == kOfDiscovery) {
      ++named;
      kept += keep;
    }
    return true;
  });
  return named == 0 || kept > 0;
}

bool is_liveliness_of(const unsigned char* payload, std::size_t size, const unsigned char* prefix) {
  constexpr std::size_t kEncapsulation = 4;
  return size >= kEncapsulation + kPrefixSize &&
         std::memcmp(payload + kEncapsulation, prefix, kPrefixSize) == 0;
}

bool check_liveliness(const unsigned char* payload, std::size_t size) {
  constexpr std::size_t kBeforeData = 4 + kPrefixSize + 4;  // encapsulation, participant, kind
  // Fast DDS calls it a list of parameters (2, 3), which it is not.
  if (size < kBeforeData + 4 || payload[0] != 0 || payload[1] > 3) return false;
  return get32(payload + kBeforeData, payload[1] % 2 == 1) <= size - kBeforeData - 4;
}

}  // namespace skein::dds::rtps_message
