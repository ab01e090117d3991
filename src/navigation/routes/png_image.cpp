#include "navigation/routes/png_image.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace skein::navigation {
namespace {

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
      bytes_(3 * static_cast<std::size_t>(height) * static_cast<std::size_t>(width)) {}

void Image::set(int x, int y, const Colour& colour) {
  std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                        static_cast<std::size_t>(x));
  for (const double part : {colour.red, colour.green, colour.blue}) {
    bytes_[at++] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
  }
}

std::string Image::png_base64() const {
  png_image picture{};
  picture.version = PNG_IMAGE_VERSION;
  picture.width = static_cast<png_uint_32>(width_);
  picture.height = static_cast<png_uint_32>(height_);
  picture.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(picture);
  std::string png(size, '\0');
  if (!png_image_write_to_memory(&picture, png.data(), &size, 0, bytes_.data(), 0, nullptr)) {
    throw std::runtime_error(std::string("libpng cannot write the picture: ") + picture.message);
  }
  png.resize(size);
  return base64(png);
}

}  // namespace skein::navigation
