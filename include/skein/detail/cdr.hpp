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
#include "skein/detail/representation.hpp"

namespace skein::idl {

/// The C++ types of IDL's basic types.
template <class T>
concept Primitive =
    std::same_as<T, bool> || std::same_as<T, char> || std::same_as<T, std::uint8_t> ||
    std::same_as<T, std::int8_t> || std::same_as<T, std::int16_t> ||
    std::same_as<T, std::uint16_t> || std::same_as<T, std::int32_t> ||
    std::same_as<T, std::uint32_t> || std::same_as<T, std::int64_t> ||
    std::same_as<T, std::uint64_t> || std::same_as<T, float> || std::same_as<T, double>;

/// A bit of a bitmask.
struct Flag {
  std::string_view name;
  std::uint64_t bit;
};

enum class ByteOrder { Big, Little };

/// The encapsulation header of types that travel as XCDR1.
inline constexpr std::array<std::byte, 4> kEncapsulation = encapsulation(Representation::Xcdr1);

/// Maximum nesting depth of recursive types in CDR, for writing and reading. JSON text is read to
/// four times as many levels, and written without a limit.
inline constexpr unsigned kMaximumNesting = 100;

/// How much more memory than the message a value may take, before a mebibyte: an absent member has
/// one byte.
inline constexpr std::size_t kMostMemory = 1024;

/// Writes values as XCDR1 or XCDR2 after the present content of a message, as its encapsulation
/// header says. Exists only inside append_cdr(). Padding is always zero. Throws InvalidArgument for
/// values that CDR cannot carry: text with a zero byte, more than 2^32-1 elements, an exceeded
/// bound, an enumerator that does not exist, nesting that is too deep.
class CdrWriter {
 public:
  template <Primitive T>
  void write(T value);
  /// The elements only, without a length.
  template <Primitive T>
  void write_array(const T* values, std::size_t count);
  void write_string(std::string_view text);
  /// As UTF-16: a wide character is one unit of two bytes, wide text is preceded by its length in
  /// bytes.
  void write_wide_character(wchar_t value);
  void write_wide_string(std::wstring_view text);
  /// As IEEE 754's binary128, whatever the machine's own format is.
  void write_long_double(long double value);
  void write_length(std::size_t length);
  /// `value` must be less than `count`.
  void write_enum(std::uint32_t value, std::uint32_t count, const char* type);
  /// `value` must be one of `values`.
  template <std::signed_integral T>
  void write_enum(T value, std::span<const T> values, const char* type);
  void check_bound(std::size_t size, std::size_t bound, const char* place) const;
  /// Whether nothing is to be written for the value that lies there: see idl/left_out.hpp.
  bool leave_out(const void* value, std::size_t size);

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

  bool is_xcdr2() const noexcept;

  /// What is written while it exists is preceded by its length in bytes, if `needed`.
  class Delimiter {
   public:
    explicit Delimiter(CdrWriter& writer, bool needed = true);
    ~Delimiter();
    Delimiter(const Delimiter&) = delete;
    Delimiter& operator=(const Delimiter&) = delete;

   private:
    CdrWriter& writer_;
    std::size_t start_ = 0;
  };

  /// The header of a member of a @mutable type. Returned with the length that the member is
  /// preceded by.
  [[nodiscard]] Delimiter member(std::uint32_t id, bool must_understand);

  struct State;
  explicit CdrWriter(State& state) : state_(state) {}

 private:
  State& state_;
};

/// Reads values from XCDR1 or XCDR2 of either byte order. Exists only inside read_cdr(). Every
/// length is checked against the remaining bytes before anything is allocated. Throws
/// MalformedSample for everything that does not fit.
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
  wchar_t read_wide_character();
  void read_wide_string(std::wstring& text);
  long double read_long_double();
  /// A sequence's length. Checks that `element_size` bytes per element are left.
  std::uint32_t read_length(std::size_t element_size);
  std::uint32_t read_enum(std::uint32_t count);
  template <std::signed_integral T>
  T read_enum(std::span<const T> values);
  void check_bound(std::size_t size, std::size_t bound, const char* place) const;
  std::size_t remaining() const noexcept;
  /// The value that was left out here, or null.
  const void* left_out(std::size_t size, std::size_t alignment);
  /// Of so much memory for elements, which may be larger than what stands for them in the message.
  /// Fails where all together takes more than kMostMemory times the size of the message.
  void take_memory(std::size_t size);

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

  bool is_xcdr2() const noexcept;

  /// While it exists, nothing is read beyond what the length before it says; then comes what stands
  /// behind that, whatever was read. Without effect unless `needed`.
  class Delimited {
   public:
    explicit Delimited(CdrReader& reader, bool needed = true);
    Delimited(CdrReader& reader, std::size_t length);
    ~Delimited();
    Delimited(const Delimited&) = delete;
    Delimited& operator=(const Delimited&) = delete;

    /// Whether anything is left.
    bool more() const noexcept { return reader_.remaining() > 0; }

   private:
    CdrReader& reader_;
    std::size_t end_ = 0;
    std::size_t outer_end_ = 0;
  };

  /// The header of a member of a @mutable type.
  struct Member {
    std::uint32_t id;
    bool must_understand;
    std::size_t length;
  };
  Member read_member();
  /// For a member that the type does not have. Throws MalformedSample if it must be understood.
  void pass_over(const Member& member) const;

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
                            Representation representation, void (*read)(CdrReader&, const void*),
                            const void* context);

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
/// header, and returns the offset of its end. Throws MalformedSample, also where the message is
/// XCDR1 and `representation`, that of the value, is not. (A type that does not grow is read from
/// both: in a call it may stand beside others.)
template <std::invocable<CdrReader&> Read>
std::size_t read_cdr(std::span<const std::byte> message, std::size_t offset,
                     Representation representation, Read&& read) {
  return read_cdr_erased(
      message, offset, representation,
      [](CdrReader& reader, const void* f) {
        (*static_cast<const std::remove_reference_t<Read>*>(f))(reader);
      },
      &read);
}

}  // namespace skein::idl
