#include "skein/guid.hpp"

#include <algorithm>
#include <random>

namespace skein {
namespace {

int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

}  // namespace

Guid Guid::participant() const noexcept {
  Guid prefix = *this;
  std::fill(prefix.bytes.begin() + 12, prefix.bytes.end(), std::uint8_t{0});
  return prefix;
}

std::string Guid::hex() const {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(32);
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::optional<Guid> Guid::from_hex(std::string_view text) noexcept {
  Guid guid;
  if (text.size() != 2 * guid.bytes.size()) return std::nullopt;
  for (std::size_t i = 0; i < guid.bytes.size(); ++i) {
    const int high = hex_digit(text[2 * i]);
    const int low = hex_digit(text[2 * i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    guid.bytes[i] = static_cast<std::uint8_t>(high << 4 | low);
  }
  return guid;
}

Guid Guid::random() {
  std::random_device source;
  Guid guid;
  for (std::size_t i = 0; i < guid.bytes.size(); i += 4) {
    const std::uint32_t word = source();
    std::memcpy(guid.bytes.data() + i, &word, 4);
  }
  return guid;
}

}  // namespace skein
