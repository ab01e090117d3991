#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace skein::navigation {

struct Colour {
  double red, green, blue;  ///< 0 to 1.
};

/// `share` of the way from one colour to the other.
Colour mix(const Colour& one, const Colour& other, double share);

/// A picture of points, the northernmost row first.
class Image {
 public:
  Image(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  void set(int x, int y, const Colour& colour);

  /// As a PNG file, in base64, ready for a data URI.
  std::string png_base64() const;

 private:
  int width_;
  int height_;
  std::vector<std::uint8_t> bytes_;  ///< Red, green, blue; row after row.
};

}  // namespace skein::navigation
