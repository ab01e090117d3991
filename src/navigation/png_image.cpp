#include "png_image.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace skein::navigation {
namespace {

void append_u32(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xFF);
}

void append_chunk(std::string& png, std::string_view type, std::string_view data) {
  append_u32(png, static_cast<std::uint32_t>(data.size()));
  std::string body(type);
  body += data;
  png += body;
  append_u32(png, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(body.data()),
                                                   static_cast<uInt>(body.size()))));
}

std::string compressed(const std::vector<std::uint8_t>& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, bytes.data(), bytes.size(), 9) !=
      Z_OK) {
    throw std::bad_alloc();
  }
  out.resize(size);
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (i + j < bytes.size() ? static_cast<std::uint8_t>(bytes[i + j]) : 0u);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += i + j <= bytes.size() ? kDigits[group >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

}  // namespace

Colour mix(const Colour& one, const Colour& other, double share) {
  return {std::lerp(one.red, other.red, share), std::lerp(one.green, other.green, share),
          std::lerp(one.blue, other.blue, share)};
}

Image::Image(int width, int height)
    : width_(width),
      height_(height),
      bytes_(static_cast<std::size_t>(height) * (3 * static_cast<std::size_t>(width) + 1)) {}

void Image::set(int x, int y, const Colour& colour) {
  std::size_t at = static_cast<std::size_t>(y) * (3 * static_cast<std::size_t>(width_) + 1) + 1 +
                   3 * static_cast<std::size_t>(x);
  for (const double part : {colour.red, colour.green, colour.blue}) {
    bytes_[at++] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
  }
}

std::string Image::png_base64() const {
  // Each byte as its difference to the same colour of the point to the left: smooth pictures
  // shrink.
  std::vector<std::uint8_t> filtered = bytes_;
  const std::size_t line = 3 * static_cast<std::size_t>(width_) + 1;
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y) {
    filtered[y * line] = 1;
    for (std::size_t i = line - 1; i > 3; --i) filtered[y * line + i] -= bytes_[y * line + i - 3];
  }
  std::string header;
  append_u32(header, static_cast<std::uint32_t>(width_));
  append_u32(header, static_cast<std::uint32_t>(height_));
  header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, red-green-blue, nothing special.
  std::string png = "\x89PNG\r\n\x1a\n";
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", compressed(filtered));
  append_chunk(png, "IEND", "");
  return base64(png);
}

}  // namespace skein::navigation
