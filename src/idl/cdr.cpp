#include "skein/detail/cdr.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/exceptions/BadParamException.h>
#include <fastcdr/exceptions/NotEnoughMemoryException.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "skein/detail/codec.hpp"

namespace skein::idl {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using eprosima::fastcdr::exception::NotEnoughMemoryException;

constexpr std::size_t kHeaderSize = kEncapsulation.size();
constexpr std::size_t kFirstCapacity = 512;

/// Thrown by a bulk write that knows how much room it needs.
struct RoomNeeded {
  std::size_t capacity;
};

Cdr::Endianness endianness(ByteOrder order) {
  return order == ByteOrder::Big ? Cdr::BIG_ENDIANNESS : Cdr::LITTLE_ENDIANNESS;
}

std::size_t padding(std::size_t position, std::size_t alignment) {
  return (alignment - position % alignment) % alignment;
}

std::string too_deep() {
  return "is nested more than " + std::to_string(kMaximumNesting) + " levels deep";
}

std::string beyond_bound(std::size_t size, std::size_t bound) {
  return "holds " + std::to_string(size) + " elements, at most " + std::to_string(bound) +
         " are allowed";
}

}  // namespace

struct CdrWriter::State {
  State(char* memory, std::size_t size, ByteOrder order)
      : buffer(memory, size), cdr(buffer, endianness(order), Cdr::DDS_CDR) {}

  std::size_t position() const { return cdr.getSerializedDataLength(); }

  /// Fast CDR skips padding; ours is written, so that no old memory goes out.
  void align(std::size_t alignment) {
    for (std::size_t n = padding(position(), alignment); n > 0; --n) cdr.serialize(std::uint8_t{0});
  }

  FastBuffer buffer;
  Cdr cdr;
  unsigned nesting = 0;
};

template <Primitive T>
void CdrWriter::write(T value) {
  state_.align(sizeof(T));
  state_.cdr.serialize(value);
}

template <Primitive T>
void CdrWriter::write_array(const T* values, std::size_t count) {
  if (count == 0) return;
  state_.align(sizeof(T));
  const std::size_t end = state_.position() + count * sizeof(T);
  if (end > state_.buffer.getBufferSize()) throw RoomNeeded{end + kHeaderSize};
  state_.cdr.serializeArray(values, count);
}

void CdrWriter::write_length(std::size_t length) {
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    throw InvalidArgument("a sequence of " + std::to_string(length) +
                          " elements cannot travel: CDR counts with 32 bits");
  }
  write(static_cast<std::uint32_t>(length));
}

void CdrWriter::write_string(std::string_view text) {
  if (text.find('\0') != std::string_view::npos) {
    throw InvalidArgument(
        "text with a zero byte cannot travel as an IDL string; use sequence<octet>");
  }
  write_length(text.size() + 1);
  write_array(text.data(), text.size());
  write('\0');
}

void CdrWriter::write_enum(std::uint32_t value, std::uint32_t count, const char* type) {
  if (value >= count) {
    throw InvalidArgument(std::to_string(value) + " is no value of the enumeration " + type);
  }
  write(value);
}

void CdrWriter::check_bound(std::size_t size, std::size_t bound, const char* place) const {
  if (size > bound) throw InvalidArgument(place + (" " + beyond_bound(size, bound)));
}

CdrWriter::Nesting::Nesting(CdrWriter& writer) : writer_(writer) {
  if (writer_.state_.nesting >= kMaximumNesting) throw InvalidArgument("the value " + too_deep());
  ++writer_.state_.nesting;
}

CdrWriter::Nesting::~Nesting() { --writer_.state_.nesting; }

struct CdrReader::State {
  State(std::span<const std::byte> content, ByteOrder order)
      : buffer(const_cast<char*>(reinterpret_cast<const char*>(content.data())), content.size()),
        cdr(buffer, endianness(order), Cdr::DDS_CDR),
        size(content.size()) {}

  std::size_t position() const { return cdr.getSerializedDataLength(); }

  /// Fast CDR aligns by what it read last, which a jump over a string does not change.
  void align(std::size_t alignment) { cdr.jump(padding(position(), alignment)); }

  FastBuffer buffer;
  Cdr cdr;
  std::size_t size;
  unsigned nesting = 0;
};

std::size_t CdrReader::remaining() const noexcept { return state_.size - state_.position(); }

template <Primitive T>
T CdrReader::read() {
  if (remaining() < padding(state_.position(), sizeof(T)) + sizeof(T))
    fail("the message ends here");
  state_.align(sizeof(T));
  if constexpr (std::is_same_v<T, bool>) {
    std::uint8_t value;
    state_.cdr.deserialize(value);
    if (value > 1) fail(std::to_string(value) + " is no boolean");
    return value == 1;
  } else {
    T value;
    state_.cdr.deserialize(value);
    return value;
  }
}

template <Primitive T>
void CdrReader::read_array(T* values, std::size_t count) {
  if (count == 0) return;
  const std::size_t skipped = padding(state_.position(), sizeof(T));
  if (remaining() < skipped || (remaining() - skipped) / sizeof(T) < count) {
    fail(std::to_string(count) + " elements do not fit into the " + std::to_string(remaining()) +
         " bytes that are left");
  }
  state_.align(sizeof(T));
  if constexpr (std::is_same_v<T, bool>) {
    for (std::size_t i = 0; i < count; ++i) values[i] = read<bool>();
  } else {
    state_.cdr.deserializeArray(values, count);
  }
}

std::span<const std::byte> CdrReader::read_bytes(std::size_t count) {
  if (count > remaining()) {
    fail(std::to_string(count) + " bytes do not fit into the " + std::to_string(remaining()) +
         " that are left");
  }
  const auto* first = reinterpret_cast<const std::byte*>(state_.cdr.getCurrentPosition());
  state_.cdr.jump(count);
  return {first, count};
}

std::uint32_t CdrReader::read_length(std::size_t element_size) {
  const auto length = read<std::uint32_t>();
  if (length > remaining() / element_size) {
    fail("a length of " + std::to_string(length) + " does not fit into the " +
         std::to_string(remaining()) + " bytes that are left");
  }
  return length;
}

void CdrReader::read_string(std::string& text) {
  const std::uint32_t length = read_length(1);
  if (length == 0) return text.clear();  // Fast CDR writes a null char* so.
  const auto* characters = reinterpret_cast<const char*>(read_bytes(length).data());
  const void* end = std::memchr(characters, 0, length);
  if (end != characters + length - 1) {
    fail(end ? "a string holds a zero byte" : "a string is not terminated");
  }
  text.assign(characters, length - 1);
}

std::uint32_t CdrReader::read_enum(std::uint32_t count) {
  const auto value = read<std::uint32_t>();
  if (value >= count) fail(std::to_string(value) + " is no value of the enumeration");
  return value;
}

void CdrReader::check_bound(std::size_t size, std::size_t bound, const char* place) const {
  if (size > bound) {
    throw MalformedSample("malformed sample: " + std::string(place) + ' ' +
                          beyond_bound(size, bound));
  }
}

void CdrReader::fail(std::string_view reason) const {
  throw MalformedSample("malformed sample: " + std::string(place_) + " at offset " +
                        std::to_string(state_.position() + kHeaderSize) + ": " +
                        std::string(reason));
}

CdrReader::Nesting::Nesting(CdrReader& reader) : reader_(reader) {
  if (reader_.state_.nesting >= kMaximumNesting) reader_.fail("the value " + too_deep());
  ++reader_.state_.nesting;
}

CdrReader::Nesting::~Nesting() { --reader_.state_.nesting; }

void append_cdr_erased(Bytes& message, ByteOrder order, void (*write)(CdrWriter&, const void*),
                       const void* context) {
  const std::size_t start = message.size();
  if (start < kHeaderSize) throw Internal("append_cdr: the message has no encapsulation header");
  std::size_t needed = kFirstCapacity;
  for (;;) {
    message.reserve(needed);
    try {
      CdrWriter::State state(reinterpret_cast<char*>(message.data()) + kHeaderSize,
                             message.capacity() - kHeaderSize, order);
      state.cdr.jump(start - kHeaderSize);
      CdrWriter writer(state);
      write(writer, context);
      message.resize(kHeaderSize + state.position());
      return;
    } catch (const RoomNeeded& room) {
      needed = std::max(message.capacity() * 2, room.capacity + kFirstCapacity);
    } catch (const NotEnoughMemoryException&) {
      needed = message.capacity() * 2;
    }
  }
}

std::size_t read_cdr_erased(std::span<const std::byte> message, std::size_t offset,
                            void (*read)(CdrReader&, const void*), const void* context) {
  if (message.size() < kHeaderSize || offset < kHeaderSize || offset > message.size()) {
    throw MalformedSample("malformed sample: " + std::to_string(message.size()) +
                          " bytes cannot hold a value at offset " + std::to_string(offset));
  }
  const auto kind =
      std::to_integer<unsigned>(message[0]) << 8 | std::to_integer<unsigned>(message[1]);
  if (kind > 1) {
    throw MalformedSample("malformed sample: representation " + std::to_string(kind) +
                          " is not PLAIN_CDR (0 or 1); the writer must be set to XCDR1");
  }
  CdrReader::State state(message.subspan(kHeaderSize),
                         kind == 0 ? ByteOrder::Big : ByteOrder::Little);
  state.cdr.jump(offset - kHeaderSize);
  CdrReader reader(state);
  read(reader, context);
  return kHeaderSize + state.position();
}

#define SKEIN_INSTANTIATE(T)                                      \
  template void CdrWriter::write<T>(T);                           \
  template void CdrWriter::write_array<T>(const T*, std::size_t); \
  template T CdrReader::read<T>();                                \
  template void CdrReader::read_array<T>(T*, std::size_t);
SKEIN_INSTANTIATE(bool)
SKEIN_INSTANTIATE(char)
SKEIN_INSTANTIATE(std::uint8_t)
SKEIN_INSTANTIATE(std::int16_t)
SKEIN_INSTANTIATE(std::uint16_t)
SKEIN_INSTANTIATE(std::int32_t)
SKEIN_INSTANTIATE(std::uint32_t)
SKEIN_INSTANTIATE(std::int64_t)
SKEIN_INSTANTIATE(std::uint64_t)
SKEIN_INSTANTIATE(float)
SKEIN_INSTANTIATE(double)
#undef SKEIN_INSTANTIATE

}  // namespace skein::idl
