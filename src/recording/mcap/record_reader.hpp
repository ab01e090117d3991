#pragma once

#include <concepts>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "recording/mcap/format.hpp"

namespace skein::recording {

/// A record does not hold what it should.
struct MalformedRecord : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads fields from bytes that anybody may have written. Throws MalformedRecord if they end too
/// early.
class RecordReader {
 public:
  explicit RecordReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <std::unsigned_integral T>
  T number() {
    T value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::span<const std::byte> bytes(std::uint64_t count) {
    if (count > rest_.size()) {
      throw MalformedRecord(std::to_string(count) + " bytes are announced, and " +
                            std::to_string(rest_.size()) + " are left");
    }
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  std::string text() {
    const auto taken = bytes(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }
  /// A part with fields of its own.
  RecordReader part() { return RecordReader(bytes(number<std::uint32_t>())); }
  std::map<std::string, std::string> text_map();

  std::size_t size() const noexcept { return rest_.size(); }

 private:
  std::span<const std::byte> rest_;
};

struct Record {
  std::uint8_t opcode;
  std::span<const std::byte> fields;
};

/// The next record of `bytes`; nothing if no whole one is left.
std::optional<Record> next_record(RecordReader& bytes);

}  // namespace skein::recording
