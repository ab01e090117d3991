#include "skein/detail/key_hash.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "skein/error.hpp"

namespace skein::idl {
namespace {

constexpr std::size_t kBlock = 64;
constexpr std::array<std::array<int, 4>, 4> kRotations{
    {{7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}}};

/// RFC 1321, 3.4: the integer part of 2^32 times |sin(i + 1)|.
const std::array<std::uint32_t, 64>& sines() {
  static const auto table = [] {
    std::array<std::uint32_t, 64> made;
    for (std::size_t i = 0; i < made.size(); ++i) {
      made[i] = static_cast<std::uint32_t>(std::floor(std::abs(std::sin(double(i + 1))) * 0x1p32));
    }
    return made;
  }();
  return table;
}

using Digest = std::array<std::uint32_t, 4>;

std::uint32_t word_at(const std::byte* block, std::size_t index) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= std::to_integer<std::uint32_t>(block[4 * index + i]) << (8 * i);
  return word;
}

void add_block(Digest& digest, const std::byte* block) {
  auto [a, b, c, d] = digest;
  for (std::size_t i = 0; i < 64; ++i) {
    const std::size_t round = i / 16;
    std::uint32_t mixed;
    std::size_t index;
    switch (round) {
      case 0:
        mixed = (b & c) | (~b & d), index = i;
        break;
      case 1:
        mixed = (d & b) | (~d & c), index = (5 * i + 1) % 16;
        break;
      case 2:
        mixed = b ^ c ^ d, index = (3 * i + 5) % 16;
        break;
      default:
        mixed = c ^ (b | ~d), index = (7 * i) % 16;
        break;
    }
    const std::uint32_t sum = a + mixed + sines()[i] + word_at(block, index);
    a = d;
    d = c;
    c = b;
    b += std::rotl(sum, kRotations[round][i % 4]);
  }
  digest = {digest[0] + a, digest[1] + b, digest[2] + c, digest[3] + d};
}

}  // namespace

Guid md5(std::span<const std::byte> content) noexcept {
  Digest digest{0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476};
  const std::uint64_t bits = std::uint64_t{content.size()} * 8;
  for (; content.size() >= kBlock; content = content.subspan(kBlock))
    add_block(digest, content.data());
  std::array<std::byte, 2 * kBlock> tail{};
  std::ranges::copy(content, tail.begin());
  tail[content.size()] = std::byte{0x80};
  const std::size_t size = content.size() + 9 <= kBlock ? kBlock : 2 * kBlock;
  for (std::size_t i = 0; i < 8; ++i) tail[size - 8 + i] = static_cast<std::byte>(bits >> (8 * i));
  for (std::size_t at = 0; at < size; at += kBlock) add_block(digest, tail.data() + at);
  Guid result;
  for (std::size_t i = 0; i < 16; ++i) {
    result.bytes[i] = static_cast<std::uint8_t>(digest[i / 4] >> (8 * (i % 4)));
  }
  return result;
}

Guid key_hash_of(std::span<const std::byte> message, bool short_key) {
  if (message.size() < kEncapsulation.size())
    throw Internal("key_hash_of: no encapsulation header");
  const auto key = message.subspan(kEncapsulation.size());
  if (!short_key) return md5(key);
  Guid hash;
  std::memcpy(hash.bytes.data(), key.data(), std::min(key.size(), hash.bytes.size()));
  return hash;
}

}  // namespace skein::idl
