#pragma once

#include <bit>
#include <concepts>
#include <map>
#include <string>
#include <string_view>

#include "recording/mcap/format.hpp"
#include "skein/detail/bytes.hpp"

namespace skein::recording {

/// Appends fields, little-endian, to `bytes`, which must outlive it.
class RecordWriter {
 public:
  explicit RecordWriter(Bytes& bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  void number(T value) {
    static_assert(std::endian::native == std::endian::little,
                  "numbers would have to be turned round");
    bytes_.append(std::as_bytes(std::span(&value, 1)));
  }
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_.append(std::as_bytes(std::span(value)));
  }
  void text_map(const std::map<std::string, std::string>& values);

  /// A record: what `write_fields()` appends, behind its opcode and its length. Gives the size of
  /// all that.
  template <class WriteFields>
  std::uint64_t record(Opcode opcode, WriteFields&& write_fields) {
    const std::size_t start = bytes_.size();
    number(static_cast<std::uint8_t>(opcode));
    number(std::uint64_t{0});
    write_fields();
    set_number(start + 1, std::uint64_t{bytes_.size() - start - kRecordHeader});
    return bytes_.size() - start;
  }

  /// Replaces a number that was appended before.
  template <std::unsigned_integral T>
  void set_number(std::size_t at, T value) {
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }

 private:
  Bytes& bytes_;
};

}  // namespace skein::recording
