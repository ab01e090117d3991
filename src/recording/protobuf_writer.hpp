#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace skein::recording {

/// Appends fields of a Protocol Buffers message.
class ProtobufWriter {
 public:
  void number(unsigned field, std::uint64_t value) {
    varint(field << 3);
    varint(value);
  }
  void fixed(unsigned field, std::uint64_t value) {
    varint(field << 3 | 1);
    for (unsigned i = 0; i < sizeof value; ++i) bytes_ += static_cast<char>(value >> 8 * i);
  }
  void text(unsigned field, std::string_view value) {
    varint(field << 3 | 2);
    varint(value.size());
    bytes_ += value;
  }
  void message(unsigned field, const ProtobufWriter& message) { text(field, message.bytes_); }

  const std::string& bytes() const noexcept { return bytes_; }

 private:
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

}  // namespace skein::recording
