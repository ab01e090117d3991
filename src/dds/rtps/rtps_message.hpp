#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>

#include "skein/guid.hpp"

/// The form of RTPS 2.3 messages (OMG formal/2019-04-03), as far as Skein looks at what it receives
/// before a vendor does.
namespace skein::dds::rtps_message {

inline constexpr std::size_t kRtpsHeaderSize = 20;
inline constexpr std::size_t kVendor = 6;  // where it stands in the header
inline constexpr std::size_t kPrefix = 8;  // the sender's GUID prefix
inline constexpr std::size_t kPrefixSize = 12;
inline constexpr std::size_t kSubmessageHeaderSize = 4;

/// The entity id of the writer that announces its participant, and of the reader of such.
inline constexpr unsigned char kAnnouncer[] = {0x00, 0x01, 0x00, 0xc2};
inline constexpr unsigned char kAnnouncementReader[] = {0x00, 0x01, 0x00, 0xc7};

/// The entity ids of the writers that announce writers and readers, and of the readers of such.
inline constexpr unsigned char kWriterAnnouncer[] = {0x00, 0x00, 0x03, 0xc2};
inline constexpr unsigned char kWriterDetector[] = {0x00, 0x00, 0x03, 0xc7};
inline constexpr unsigned char kReaderAnnouncer[] = {0x00, 0x00, 0x04, 0xc2};
inline constexpr unsigned char kReaderDetector[] = {0x00, 0x00, 0x04, 0xc7};

/// The entity id of the writer that says that its participant's writers live.
inline constexpr unsigned char kLivelinessWriter[] = {0x00, 0x02, 0x00, 0xc2};

/// Ids of parameters.
inline constexpr std::uint16_t kSentinel = 0x0001;
inline constexpr std::uint16_t kParticipantLease = 0x0002;
inline constexpr std::uint16_t kParticipantGuid = 0x0050;
inline constexpr std::uint16_t kEndpointGuid = 0x005a;
inline constexpr std::uint16_t kKeyHash = 0x0070;

enum Kind : unsigned char {
  kPad = 0x01,
  kAckNack = 0x06,
  kHeartbeat = 0x07,
  kGap = 0x08,
  kInfoTimestamp = 0x09,
  kInfoSource = 0x0c,
  kInfoDestination = 0x0e,
  kNackFrag = 0x12,
  kHeartbeatFrag = 0x13,
  kData = 0x15,
  kDataFrag = 0x16,
  kFirstOfVendors = 0x80,
};

/// Of each submessage, of DATA, and of ACKNACK.
enum Flag : unsigned char {
  kLittleEndian = 0x01,
  kInlineQos = 0x02,
  kFinal = 0x02,
  kHasData = 0x04,
  kHasKey = 0x08,
};

inline std::uint16_t get16(const unsigned char* at, bool little) {
  return static_cast<std::uint16_t>(little ? at[0] | at[1] << 8 : at[1] | at[0] << 8);
}

inline std::uint32_t get32(const unsigned char* at, bool little) {
  const std::uint32_t first = get16(at, little);
  const std::uint32_t second = get16(at + 2, little);
  return little ? first | second << 16 : first << 16 | second;
}

inline void put16(unsigned char* at, std::uint16_t value, bool little) {
  at[little ? 0 : 1] = static_cast<unsigned char>(value);
  at[little ? 1 : 0] = static_cast<unsigned char>(value >> 8);
}

inline void put32(unsigned char* at, std::uint32_t value, bool little) {
  for (int i = 0; i < 4; ++i) at[little ? i : 3 - i] = static_cast<unsigned char>(value >> (8 * i));
}

/// Negative ones are none.
inline std::int64_t get_sequence_number(const unsigned char* at, bool little) {
  return static_cast<std::int64_t>(std::uint64_t{get32(at, little)} << 32 | get32(at + 4, little));
}

inline void put_sequence_number(unsigned char* at, std::int64_t number, bool little) {
  put32(at, static_cast<std::uint32_t>(number >> 32), little);
  put32(at + 4, static_cast<std::uint32_t>(number), little);
}

/// A submessage within a message.
struct Submessage {
  unsigned char* header = nullptr;
  std::size_t size = 0;  ///< Of its body.
  bool last = false;     ///< It leaves its length out and ends with the message.

  unsigned char kind() const { return header[0]; }
  bool flag(unsigned char mask) const { return (header[1] & mask) != 0; }
  bool little() const { return flag(kLittleEndian); }
  unsigned char* body() const { return header + kSubmessageHeaderSize; }
};

/// The submessage that begins at `at`; nothing where it does not lie wholly within the message.
inline std::optional<Submessage> submessage_at(unsigned char* message, std::size_t size,
                                               std::size_t at) {
  if (size < at + kSubmessageHeaderSize) return std::nullopt;
  Submessage found{message + at};
  const std::size_t left = size - at - kSubmessageHeaderSize;
  found.size = get16(found.header + 2, found.little());
  if (found.size == 0 && found.kind() != kPad && found.kind() != kInfoTimestamp) {
    found.size = left;
    found.last = true;
  }
  if (found.size > left) return std::nullopt;
  return found;
}

/// Calls `visit` with each submessage of a message that the guard has passed.
template <class Visit>
void for_each_submessage(unsigned char* message, std::size_t size, Visit&& visit) {
  for (std::size_t at = kRtpsHeaderSize; at < size;) {
    const auto submessage = submessage_at(message, size, at);
    if (!submessage) return;
    visit(*submessage);
    at += kSubmessageHeaderSize + submessage->size;
  }
}

/// The same of a message that Fast DDS 3 is about to send. It lies in several buffers, each a
/// `buffer` and its `size`, and a sample in one of its own: `visit` gets what stands before that.
template <class Buffers, class Visit>
void for_each_submessage(const Buffers& buffers, Visit&& visit) {
  std::size_t rest = kRtpsHeaderSize;  // of what was visited
  for (const auto& buffer : buffers) {
    auto* const bytes = static_cast<unsigned char*>(const_cast<void*>(buffer.buffer));
    std::size_t at = std::min<std::size_t>(rest, buffer.size);
    rest -= at;
    while (at + kSubmessageHeaderSize <= buffer.size) {
      Submessage submessage{bytes + at};
      const std::size_t size = get16(submessage.header + 2, submessage.little());
      at += kSubmessageHeaderSize;
      submessage.size = std::min(size, buffer.size - at);
      visit(submessage);
      at += submessage.size;
      rest = size - submessage.size;
    }
  }
}

/// Who sent a message that is no shorter than its header: the participant's GUID without its entity
/// id.
inline Guid sender(const unsigned char* message) {
  Guid result;
  std::memcpy(result.bytes.data(), message + kPrefix, kPrefixSize);
  return result;
}

/// The entity id of an endpoint, as a number (RTPS 9.3.1.2).
inline std::uint32_t entity_of(const Guid& endpoint) {
  return get32(endpoint.bytes.data() + kPrefixSize, false);
}

/// The header of a message from a participant on Fast DDS 2.9, which writes RTPS 2.3.
inline void put_header(unsigned char* message, const Guid& sender) {
  constexpr unsigned char kStart[kPrefix] = {'R', 'T', 'P', 'S', 2, 3, 1, 15};
  std::memcpy(message, kStart, sizeof kStart);
  std::memcpy(message + kPrefix, sender.bytes.data(), kPrefixSize);
}

/// A set of sequence or fragment numbers: its base, the number of its bits, and where it ends.
struct NumberSet {
  std::int64_t base = 0;
  std::uint32_t bits = 0;
  std::size_t end = 0;
};

/// Of sequence numbers, at `at` of the body; nothing where it reaches beyond it, has more than 256
/// bits, or numbers that do not exist. A base of 0 without bits is what Fast DDS begins with.
std::optional<NumberSet> sequence_number_set(const Submessage& submessage, std::size_t at);

/// Of fragment numbers.
std::optional<NumberSet> fragment_number_set(const Submessage& submessage, std::size_t at);

/// What a DATA or DATA_FRAG submessage says.
struct Data {
  const unsigned char* writer = nullptr;  ///< Its entity id.
  std::int64_t number = 0;
  unsigned char* payload = nullptr;
  std::size_t payload_size = 0;
};

/// A DATA submessage in the form that the specification asks for: its header, the list of inline
/// QoS, and the payload that its flags announce.
std::optional<Data> data(const Submessage& submessage);

/// Whether a submessage that the guard has passed announces a participant, or its end.
inline bool is_announcement(const Submessage& submessage) {
  constexpr std::size_t kWriter = 8;
  return submessage.kind() == kData &&
         std::memcmp(submessage.body() + kWriter, kAnnouncer, sizeof kAnnouncer) == 0;
}

/// What a DATA_FRAG submessage says beside that.
struct Fragments {
  std::uint32_t first = 0;
  std::uint16_t count = 0;
  std::uint16_t size = 0;
  std::uint32_t sample_size = 0;

  std::uint32_t in_sample() const { return (sample_size + size - 1u) / size; }
};

/// Also that the fragments exist in a sample of that size, and are there.
std::optional<Data> data_frag(const Submessage& submessage, Fragments& fragments);

/// A parameter of a list.
struct Parameter {
  unsigned char* header = nullptr;  ///< Where its id stands.
  std::uint16_t id = 0;
  unsigned char* value = nullptr;
  std::size_t size = 0;
  bool little = false;
};

/// Calls `visit` with each parameter until it returns false or the list ends. How long the list is,
/// with its end; nothing where `visit` ended it, or where it does not end within `size` bytes.
template <class Visit>
std::optional<std::size_t> for_each_parameter(unsigned char* list, std::size_t size, bool little,
                                              Visit&& visit) {
  for (std::size_t at = 0; at + 4 <= size;) {
    const std::uint16_t id = get16(list + at, little);
    if (id == kSentinel) return at + 4;
    const std::size_t length = get16(list + at + 2, little);
    if (length % 4 != 0 || length > size - at - 4) return std::nullopt;
    if (!visit(Parameter{list + at, id, list + at + 4, length, little})) return std::nullopt;
    at += 4 + length;
  }
  return std::nullopt;
}

/// The same of a payload, whose first four bytes say how it is encoded; nothing where they do not
/// say that it is a list of parameters.
template <class Visit>
std::optional<std::size_t> for_each_parameter_of(unsigned char* payload, std::size_t size,
                                                 Visit&& visit) {
  constexpr unsigned char kBigEndianList = 2;
  constexpr unsigned char kLittleEndianList = 3;
  if (size < 4 || payload[0] != 0) return std::nullopt;
  if (payload[1] != kBigEndianList && payload[1] != kLittleEndianList) return std::nullopt;
  return for_each_parameter(payload + 4, size - 4, payload[1] == kLittleEndianList, visit);
}

/// The payload of participant and endpoint discovery: a list of parameters of which each lies
/// within it, as do their texts, lists and locators. What Skein never uses and vendors decode with
/// little care (descriptions of types, shared memory, security's tokens) is made padding.
bool check_discovery(unsigned char* payload, std::size_t size);

/// Whether a DATA submessage of participant or endpoint discovery, whose payload is good, names a
/// participant or an endpoint, and none but of the participant with that GUID prefix: in its inline
/// QoS and in its payload.
bool is_of_sender(const Submessage& submessage, const unsigned char* prefix);

/// The entity id of the participant or endpoint that a good payload of discovery is about; nothing
/// where it names none, or several.
std::optional<std::uint32_t> announced_entity(unsigned char* payload, std::size_t size);

/// Whether a payload of participant discovery that is good says for how long its participant lives
/// on unheard. Without it Fast DDS reads a lease of 0 s instead of RTPS's default. A longer lease
/// than `longest_s` is changed into that.
bool names_lease(unsigned char* payload, std::size_t size, std::uint32_t longest_s);

/// Makes padding of the locators in a good payload of discovery that `may_name` does not allow:
/// called with each IPv4 address that is no multicast group of DDS. Others than those of UDP and of
/// shared memory are padding, too. False where no address is left at which the participant can be
/// sent discovery, although some were named.
bool keep_locators(unsigned char* payload, std::size_t size,
                   const std::function<bool(std::uint32_t)>& may_name);

/// The payload of a message of liveliness of the participant with that GUID prefix.
bool check_liveliness(const unsigned char* payload, std::size_t size);
bool is_liveliness_of(const unsigned char* payload, std::size_t size, const unsigned char* prefix);

}  // namespace skein::dds::rtps_message
