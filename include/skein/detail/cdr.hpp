#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "skein/detail/bytes.hpp"
#include "skein/detail/malformed_sample.hpp"

namespace skein::idl {

/// The C++ types of IDL's basic types.
template <class T>
concept Primitive = std::same_as<T, bool> || std::same_as<T, char> ||
    std::same_as<T, std::uint8_t> || std::same_as<T, std::int16_t> ||
    std::same_as<T, std::uint16_t> || std::same_as<T, std::int32_t> ||
    std::same_as<T, std::uint32_t> || std::same_as<T, std::int64_t> ||
    std::same_as<T, std::uint64_t> || std::same_as<T, float> || std::same_as<T, double>;

enum class ByteOrder { Big, Little };

/// The encapsulation header of PLAIN_CDR, little-endian: the start of every message that Skein
/// writes.
inline constexpr std::array<std::byte, 4> kEncapsulation{std::byte{0}, std::byte{1}, std::byte{0},
                                                         std::byte{0}};

/// Maximum nesting depth of recursive types in CDR, for writing and reading. JSON text is read to
/// four times as many levels, and written without a limit.
inline constexpr unsigned kMaximumNesting = 100;

/// Writes values as PLAIN_CDR (XCDR1) after the present content of a message. Exists only inside
/// append_cdr(). Padding is always zero. Throws InvalidArgument for values that CDR cannot carry:
/// text with a zero byte, more than 2^32-1 elements, an exceeded bound, an enumerator that does not
/// exist, nesting that is too deep.
class CdrWriter {
 public:
  template <Primitive T>
  void write(T value);
  /// The elements only, without a length.
  template <Primitive T>
  void write_array(const T* values, std::size_t count);
  void write_string(std::string_view text);
  void write_length(std::size_t length);
  /// `value` must be less than `count`.
  void write_enum(std::uint32_t value, std::uint32_t count, const char* type);
  void check_bound(std::size_t size, std::size_t bound, const char* place) const;

  /// Counts the nesting of a recursive type while it exists.
  class Nesting {
   public:
    explicit Nesting(CdrWriter& writer);
    ~Nesting();
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

   private:
    CdrWriter& writer_;
  };

  struct State;
  explicit CdrWriter(State& state) : state_(state) {}

 private:
  State& state_;
};

/// Reads values from PLAIN_CDR of either byte order. Exists only inside read_cdr(). Every length is
/// checked against the remaining bytes before anything is allocated. Throws MalformedSample for
/// everything that does not fit.
class CdrReader {
 public:
  /// Names what is read next (`Type.member`), for messages.
  void at(const char* place) noexcept { place_ = place; }

  template <Primitive T>
  T read();
  template <Primitive T>
  void read_array(T* values, std::size_t count);
  /// The next `count` bytes, in place in the message.
  std::span<const std::byte> read_bytes(std::size_t count);
  void read_string(std::string& text);
  /// A sequence's length. Checks that `element_size` bytes per element are left.
  std::uint32_t read_length(std::size_t element_size);
  std::uint32_t read_enum(std::uint32_t count);
  void check_bound(std::size_t size, std::size_t bound, const char* place) const;
  std::size_t remaining() const noexcept;

  /// Throws MalformedSample with the place and the offset.
  [[noreturn]] void fail(std::string_view reason) const;

  /// Counts the nesting of a recursive type while it exists.
  class Nesting {
   public:
    explicit Nesting(CdrReader& reader);
    ~Nesting();
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

   private:
    CdrReader& reader_;
  };

  struct State;
  explicit CdrReader(State& state) : state_(state) {}

 private:
  State& state_;
  const char* place_ = "message";
};

/// append_cdr() and read_cdr() without the templates.
void append_cdr_erased(Bytes& message, ByteOrder order, void (*write)(CdrWriter&, const void*),
                       const void* context);
std::size_t read_cdr_erased(std::span<const std::byte> message, std::size_t offset,
                            void (*read)(CdrReader&, const void*), const void* context);

/// Appends what `write(CdrWriter&)` writes to `message`, which begins with an encapsulation header.
/// Alignment counts from byte 4. `write` may run more than once: when the message must grow, it
/// starts again.
template <std::invocable<CdrWriter&> Write>
void append_cdr(Bytes& message, const Write& write, ByteOrder order = ByteOrder::Little) {
  append_cdr_erased(
      message, order,
      [](CdrWriter& writer, const void* f) { (*static_cast<const Write*>(f))(writer); }, &write);
}

/// Runs `read(CdrReader&)` at `offset` (4 or more) of a message that begins with an encapsulation
/// header, and returns the offset of its end. Throws MalformedSample.
template <std::invocable<CdrReader&> Read>
std::size_t read_cdr(std::span<const std::byte> message, std::size_t offset, Read&& read) {
  return read_cdr_erased(
      message, offset,
      [](CdrReader& reader, const void* f) {
        (*static_cast<const std::remove_reference_t<Read>*>(f))(reader);
      },
      &read);
}

}  // namespace skein::idl
