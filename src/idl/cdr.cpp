#include "skein/detail/cdr.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "encode_value.hpp"
#include "left_out.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/wide_text.hpp"

namespace skein::idl {
namespace {

constexpr std::size_t kHeaderSize = kEncapsulation.size();
constexpr std::size_t kFirstCapacity = 512;

// The header of a member of a @mutable type (DDS-XTypes 1.3, 7.4.3.4.2): this flag, a code of three
// bits for the length, and the member's identifier.
constexpr std::uint32_t kMustUnderstand = 1U << 31;
constexpr unsigned kLengthCodeShift = 28;
constexpr std::uint32_t kLengthFollows = 4;
constexpr std::uint32_t kIdentifier = (1U << kLengthCodeShift) - 1;

// IEEE 754's binary128, which long double itself is on some machines.
#if __LDBL_MANT_DIG__ == 113
using Quad = long double;
#else
__extension__ using Quad = __float128;
#endif

/// Thrown by a write that finds too little.
struct RoomNeeded {
  std::size_t capacity;
};

constexpr std::size_t kXcdr2Alignment = 4;
constexpr ByteOrder kNativeOrder =
    std::endian::native == std::endian::little ? ByteOrder::Little : ByteOrder::Big;

/// Copies elements, of which those of the other byte order are turned.
template <class T>
void copy(void* to, const void* from, std::size_t count, ByteOrder order) {
  std::memcpy(to, from, count * sizeof(T));
  if (sizeof(T) == 1 || order == kNativeOrder) return;
  auto* const bytes = static_cast<std::uint8_t*>(to);
  for (std::size_t i = 0; i < count; ++i) {
    std::reverse(bytes + i * sizeof(T), bytes + (i + 1) * sizeof(T));
  }
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
  /// Zeros, so that no old memory goes out.
  void align(std::size_t alignment) {
    const std::size_t size =
        padding(position, xcdr2 ? std::min(alignment, kXcdr2Alignment) : alignment);
    if (size > 0) std::memset(take(size), 0, size);
  }

  /// The room of the next bytes.
  char* take(std::size_t size) {
    if (size > capacity - position) throw RoomNeeded{kHeaderSize + position + size};
    return memory + std::exchange(position, position + size);
  }

  char* const memory;
  const std::size_t capacity;
  const ByteOrder order;
  const bool xcdr2;
  std::size_t position;
  unsigned nesting = 0;
};

template <Primitive T>
void CdrWriter::write(T value) {
  state_.align(sizeof(T));
  copy<T>(state_.take(sizeof(T)), &value, 1, state_.order);
}

template <Primitive T>
void CdrWriter::write_array(const T* values, std::size_t count) {
  if (count == 0) return;
  state_.align(sizeof(T));
  copy<T>(state_.take(count * sizeof(T)), values, count, state_.order);
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
    throw ZeroByte();
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

template <std::signed_integral T>
void CdrWriter::write_enum(T value, std::span<const T> values, const char* type) {
  if (std::ranges::find(values, value) == values.end()) {
    throw InvalidArgument(std::to_string(value) + " is no value of the enumeration " + type);
  }
  write(value);
}

void CdrWriter::write_wide_character(wchar_t value) {
  const std::u16string units = utf16({&value, 1});
  if (units.size() != 1) {
    throw InvalidArgument("the wide character " + std::to_string(static_cast<long>(value)) +
                          " cannot travel: it has two units in UTF-16; use wstring");
  }
  write(static_cast<std::uint16_t>(units[0]));
}

void CdrWriter::write_wide_string(std::wstring_view text) {
  const std::u16string units = utf16(text);
  write_length(units.size() * 2);
  write_array(reinterpret_cast<const std::uint16_t*>(units.data()), units.size());
}

void CdrWriter::write_long_double(long double value) {
  const Quad quad = value;
  auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(quad);
  if (kNativeOrder != state_.order) std::swap(halves[0], halves[1]);
  for (const std::uint64_t half : halves) write(half);
}

CdrWriter::Nesting::Nesting(CdrWriter& writer) : writer_(writer) {
  if (writer_.state_.nesting >= kMaximumNesting) throw InvalidArgument("the value " + too_deep());
  ++writer_.state_.nesting;
}

CdrWriter::Nesting::~Nesting() { --writer_.state_.nesting; }

bool CdrWriter::is_xcdr2() const noexcept { return state_.xcdr2; }

CdrWriter::Delimiter::Delimiter(CdrWriter& writer, bool needed) : writer_(writer) {
  if (!needed) return;
  writer_.write(std::uint32_t{0});
  start_ = writer_.state_.position;
}

CdrWriter::Delimiter::~Delimiter() {
  if (start_ == 0) return;
  const auto length = static_cast<std::uint32_t>(writer_.state_.position - start_);
  copy<std::uint32_t>(writer_.state_.memory + start_ - sizeof length, &length, 1,
                      writer_.state_.order);
}

bool CdrWriter::leave_out(const void* value, std::size_t size) {
  LeavingOut* const leaving_out = LeavingOut::current();
  return leaving_out && leaving_out->take(value, size, kHeaderSize + state_.position);
}

CdrWriter::Delimiter CdrWriter::member(std::uint32_t id, bool must_understand) {
  write((must_understand ? kMustUnderstand : 0U) | kLengthFollows << kLengthCodeShift | id);
  return Delimiter(*this);
}

struct CdrReader::State {
  std::size_t skipped(std::size_t alignment) const {
    return padding(position, xcdr2 ? std::min(alignment, kXcdr2Alignment) : alignment);
  }

  /// What stands next, which is there.
  const std::byte* take(std::size_t size) {
    return content + std::exchange(position, position + size);
  }

  const std::byte* const content;
  const std::size_t whole;
  const ByteOrder order;
  const bool xcdr2;
  std::size_t position;
  std::size_t end = whole;  ///< Of what may be read now.
  std::size_t memory = 0;   ///< Of elements so far.
  unsigned nesting = 0;
};

const void* CdrReader::left_out(std::size_t size, std::size_t alignment) {
  PuttingIn* const putting_in = PuttingIn::current();
  if (!putting_in) return nullptr;
  const auto value = putting_in->take(kHeaderSize + state_.position);
  if (!value) return nullptr;
  if (value->size() != size || reinterpret_cast<std::uintptr_t>(value->data()) % alignment != 0) {
    fail(std::to_string(value->size()) + " octets are lent for a value of " + std::to_string(size));
  }
  return value->data();
}

std::size_t CdrReader::remaining() const noexcept { return state_.end - state_.position; }

template <Primitive T>
T CdrReader::read() {
  const std::size_t skipped = state_.skipped(sizeof(T));
  if (remaining() < skipped + sizeof(T)) fail("the message ends here");
  state_.position += skipped;
  if constexpr (std::is_same_v<T, bool>) {
    const auto value = std::to_integer<unsigned>(*state_.take(1));
    if (value > 1) fail(std::to_string(value) + " is no boolean");
    return value == 1;
  } else {
    T value;
    copy<T>(&value, state_.take(sizeof(T)), 1, state_.order);
    return value;
  }
}

template <Primitive T>
void CdrReader::read_array(T* values, std::size_t count) {
  if (count == 0) return;
  const std::size_t skipped = state_.skipped(sizeof(T));
  if (remaining() < skipped || (remaining() - skipped) / sizeof(T) < count) {
    fail(std::to_string(count) + " elements do not fit into the " + std::to_string(remaining()) +
         " bytes that are left");
  }
  state_.position += skipped;
  if constexpr (std::is_same_v<T, bool>) {
    for (std::size_t i = 0; i < count; ++i) values[i] = read<bool>();
  } else {
    copy<T>(values, state_.take(count * sizeof(T)), count, state_.order);
  }
}

std::span<const std::byte> CdrReader::read_bytes(std::size_t count) {
  if (count > remaining()) {
    fail(std::to_string(count) + " bytes do not fit into the " + std::to_string(remaining()) +
         " that are left");
  }
  return {state_.take(count), count};
}

std::uint32_t CdrReader::read_length(std::size_t element_size) {
  const auto length = read<std::uint32_t>();
  if (length > remaining() / element_size) {
    fail("a length of " + std::to_string(length) + " does not fit into the " +
         std::to_string(remaining()) + " bytes that are left");
  }
  return length;
}

void CdrReader::take_memory(std::size_t size) {
  constexpr std::size_t kAlways = 1 << 20;
  state_.memory += size;
  if (state_.memory > kAlways + kMostMemory * state_.whole) {
    fail("the value takes more than " + std::to_string(kMostMemory) +
         " times the memory of its message");
  }
}

void CdrReader::read_string(std::string& text) {
  const std::uint32_t length = read_length(1);
  if (length == 0) return text.clear();  // As Fast CDR writes a null char*.
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

template <std::signed_integral T>
T CdrReader::read_enum(std::span<const T> values) {
  const T value = read<T>();
  if (std::ranges::find(values, value) == values.end()) {
    fail(std::to_string(value) + " is no value of the enumeration");
  }
  return value;
}

long double CdrReader::read_long_double() {
  std::array<std::uint64_t, 2> halves{};
  for (std::uint64_t& half : halves) half = read<std::uint64_t>();
  if (kNativeOrder != state_.order) std::swap(halves[0], halves[1]);
  return static_cast<long double>(std::bit_cast<Quad>(halves));
}

wchar_t CdrReader::read_wide_character() { return static_cast<wchar_t>(read<std::uint16_t>()); }

void CdrReader::read_wide_string(std::wstring& text) {
  const std::uint32_t length = read_length(1);
  if (length % 2 != 0) fail("wide text has " + std::to_string(length) + " bytes, an odd number");
  std::u16string units(length / 2, u'\0');
  read_array(reinterpret_cast<std::uint16_t*>(units.data()), units.size());
  text = from_utf16(units);
}

void CdrReader::check_bound(std::size_t size, std::size_t bound, const char* place) const {
  if (size > bound) {
    throw MalformedSample("malformed sample: " + std::string(place) + ' ' +
                          beyond_bound(size, bound));
  }
}

void CdrReader::fail(std::string_view reason) const {
  throw MalformedSample("malformed sample: " + std::string(place_) + " at offset " +
                        std::to_string(state_.position + kHeaderSize) + ": " + std::string(reason));
}

CdrReader::Nesting::Nesting(CdrReader& reader) : reader_(reader) {
  if (reader_.state_.nesting >= kMaximumNesting) reader_.fail("the value " + too_deep());
  ++reader_.state_.nesting;
}

CdrReader::Nesting::~Nesting() { --reader_.state_.nesting; }

bool CdrReader::is_xcdr2() const noexcept { return state_.xcdr2; }

CdrReader::Delimited::Delimited(CdrReader& reader, bool needed)
    : Delimited(reader, needed ? reader.read_length(1) : reader.remaining()) {
  if (!needed) end_ = 0;
}

CdrReader::Delimited::Delimited(CdrReader& reader, std::size_t length)
    : reader_(reader), end_(reader.state_.position + length), outer_end_(reader.state_.end) {
  if (length > reader.remaining()) {
    reader.fail("a length of " + std::to_string(length) + " does not fit into the " +
                std::to_string(reader.remaining()) + " bytes that are left");
  }
  reader_.state_.end = end_;
}

CdrReader::Delimited::~Delimited() {
  if (end_ == 0) return;
  reader_.state_.position = end_;
  reader_.state_.end = outer_end_;
}

CdrReader::Member CdrReader::read_member() {
  const auto header = read<std::uint32_t>();
  const std::uint32_t code = header >> kLengthCodeShift & 7;
  Member member{header & kIdentifier, (header & kMustUnderstand) != 0,
                std::size_t{1} << (code & 3)};
  if (code == kLengthFollows) {
    member.length = read<std::uint32_t>();
  } else if (code > kLengthFollows) {
    // The length is also the first thing in the member: of bytes, or of elements of 4 or 8 bytes.
    const std::size_t begin = state_.position;
    const auto count = read<std::uint32_t>();
    state_.position = begin;
    member.length = sizeof count + std::size_t{count} * (code == 5 ? 1 : code == 6 ? 4 : 8);
  }
  return member;
}

void CdrReader::pass_over(const Member& member) const {
  if (member.must_understand) {
    fail("the member with the identifier " + std::to_string(member.id) +
         " must be understood, and this type has none");
  }
}

namespace {

bool is_xcdr2(std::span<const std::byte> message) {
  const auto kind = std::to_integer<unsigned>(message[1]);
  return message[0] == std::byte{0} && kind >= 6 && kind <= 11;
}

}  // namespace

void append_cdr_erased(Bytes& message, ByteOrder order, void (*write)(CdrWriter&, const void*),
                       const void* context) {
  const std::size_t start = message.size();
  if (start < kHeaderSize) throw Internal("append_cdr: the message has no encapsulation header");
  std::size_t needed = kFirstCapacity;
  for (;;) {
    message.reserve(needed);
    if (LeavingOut* const leaving_out = LeavingOut::current()) leaving_out->forget();
    try {
      CdrWriter::State state{reinterpret_cast<char*>(message.data()) + kHeaderSize,
                             message.capacity() - kHeaderSize, order, is_xcdr2(message),
                             start - kHeaderSize};
      CdrWriter writer(state);
      write(writer, context);
      message.resize(kHeaderSize + state.position);
      return;
    } catch (const RoomNeeded& room) {
      needed = std::max(message.capacity() * 2, room.capacity + kFirstCapacity);
    }
  }
}

std::size_t read_cdr_erased(std::span<const std::byte> message, std::size_t offset,
                            Representation representation, void (*read)(CdrReader&, const void*),
                            const void* context) {
  if (message.size() < kHeaderSize || offset < kHeaderSize || offset > message.size()) {
    throw MalformedSample("malformed sample: " + std::to_string(message.size()) +
                          " bytes cannot hold a value at offset " + std::to_string(offset));
  }
  const auto kind =
      std::to_integer<unsigned>(message[0]) << 8 | std::to_integer<unsigned>(message[1]);
  const bool xcdr2 = is_xcdr2(message);
  const bool plain = kind <= 1 || kind == 6 || kind == 7;
  if (is_xcdr2(representation) ? !xcdr2 : !plain) {
    throw MalformedSample("malformed sample: representation " + std::to_string(kind) +
                          (is_xcdr2(representation)
                               ? " is not XCDR2 (6 to 11); the writer must be set to XCDR2"
                               : " is not PLAIN_CDR (0 or 1); the writer must be set to XCDR1"));
  }
  CdrReader::State state{message.data() + kHeaderSize, message.size() - kHeaderSize,
                         kind % 2 == 0 ? ByteOrder::Big : ByteOrder::Little, xcdr2,
                         offset - kHeaderSize};
  CdrReader reader(state);
  read(reader, context);
  return kHeaderSize + state.position;
}

#define SKEIN_INSTANTIATE(T)                                      \
  template void CdrWriter::write<T>(T);                           \
  template void CdrWriter::write_array<T>(const T*, std::size_t); \
  template T CdrReader::read<T>();                                \
  template void CdrReader::read_array<T>(T*, std::size_t);
SKEIN_INSTANTIATE(bool)
SKEIN_INSTANTIATE(char)
SKEIN_INSTANTIATE(std::uint8_t)
SKEIN_INSTANTIATE(std::int8_t)
SKEIN_INSTANTIATE(std::int16_t)
SKEIN_INSTANTIATE(std::uint16_t)
SKEIN_INSTANTIATE(std::int32_t)
SKEIN_INSTANTIATE(std::uint32_t)
SKEIN_INSTANTIATE(std::int64_t)
SKEIN_INSTANTIATE(std::uint64_t)
SKEIN_INSTANTIATE(float)
SKEIN_INSTANTIATE(double)
#undef SKEIN_INSTANTIATE

#define SKEIN_INSTANTIATE_ENUM(T)                                             \
  template void CdrWriter::write_enum<T>(T, std::span<const T>, const char*); \
  template T CdrReader::read_enum<T>(std::span<const T>);
SKEIN_INSTANTIATE_ENUM(std::int8_t)
SKEIN_INSTANTIATE_ENUM(std::int16_t)
SKEIN_INSTANTIATE_ENUM(std::int32_t)
#undef SKEIN_INSTANTIATE_ENUM

}  // namespace skein::idl
