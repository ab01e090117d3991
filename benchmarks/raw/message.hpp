#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "harness/peer.hpp"

/// What raw peers send each other, by either vendor: a request's identity and the octets, as CDR.
namespace skein::benchmarks::raw {

using ClientId = std::array<std::uint8_t, 16>;

/// Identity of a request; a reply carries its request's.
struct Head {
  ClientId client{};
  std::uint32_t number = 0;
};

struct Message {
  Head head;
  Content content;
};

/// What is to be sent: the content stays where the application has it.
struct Outgoing {
  Head head;
  const Content* content = nullptr;
};

inline constexpr std::size_t kEncapsulation = 4;

inline std::size_t encoded_size(const Outgoing& message) {
  return kEncapsulation + 16 + 4 + 4 + message.content->size();
}

/// Writes encoded_size() octets. The encapsulation, CDR of the least significant byte first, is not
/// Fast CDR's, whose names for it changed with its version 2.
inline void encode(const Outgoing& message, char* to) {
  constexpr char kLittleEndianCdr[kEncapsulation] = {0, 1, 0, 0};
  std::memcpy(to, kLittleEndianCdr, kEncapsulation);
  eprosima::fastcdr::FastBuffer buffer(to + kEncapsulation, encoded_size(message) - kEncapsulation);
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS);
  cdr << message.head.client << message.head.number << *message.content;
}

/// Throws Fast CDR's exceptions where the bytes hold no message.
inline void decode(Message& message, char* from, std::size_t size) {
  const std::size_t skipped = std::min(size, kEncapsulation);
  eprosima::fastcdr::FastBuffer buffer(from + skipped, size - skipped);
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS);
  cdr >> message.head.client >> message.head.number >> message.content;
}

inline constexpr const char* kRequestTopic = "benchmark_raw_Request";
inline constexpr const char* kReplyTopic = "benchmark_raw_Reply";
inline constexpr const char* kType = "benchmark::raw::Message";

}  // namespace skein::benchmarks::raw
