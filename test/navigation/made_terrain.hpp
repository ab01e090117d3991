#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "navigation/terrain/terrain.hpp"
#include "navigation/terrain/terrain_provider.hpp"
#include "test/tools/temporary_folder.hpp"

namespace skein::navigation::testing {

/// A terrain whose heights are a function of metres north and east.
inline Terrain make_terrain(int posts, double spacing_m,
                            const std::function<double(double, double)>& height_m) {
  std::vector<float> heights;
  for (int row = 0; row < posts; ++row) {
    for (int column = 0; column < posts; ++column) {
      heights.push_back(static_cast<float>(height_m(row * spacing_m, column * spacing_m)));
    }
  }
  return Terrain("made", posts, posts, spacing_m, spacing_m, heights);
}

/// 20 km each way, all of it at sea level.
inline Terrain flat_terrain() {
  return make_terrain(201, 100, [](double, double) { return 0.0; });
}

/// The ground at a place on the earth.
inline double height_at(const Terrain& terrain, double latitude_deg, double longitude_deg) {
  const auto point = terrain.frame().value().to_ground({latitude_deg, longitude_deg});
  return terrain.height_m(point.north_m, point.east_m);
}

inline double largest_difference_m(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, static_cast<double>(std::abs(a[i] - b[i])));
  }
  return largest;
}

/// Writes posts as a tile, the first row being the northernmost.
inline void write_hgt(const std::filesystem::path& file, const std::vector<int>& posts) {
  std::string bytes;
  for (const int post : posts) {
    bytes += static_cast<char>(post >> 8 & 0xFF);
    bytes += static_cast<char>(post & 0xFF);
  }
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Writes a tile of 1201 x 1201 posts by metres over the tile: row 0 is the southernmost.
inline void write_hgt(const std::filesystem::path& file,
                      const std::function<int(int, int)>& height_m) {
  std::vector<int> posts;
  for (int row = 1200; row >= 0; --row) {
    for (int column = 0; column < 1201; ++column) posts.push_back(height_m(row, column));
  }
  write_hgt(file, posts);
}

/// A DTED tile, whose bytes can be spoilt before they are written.
struct MadeDted {
  int level = 0;
  int column_spacing_tenths = 300;
  std::string latitude = "0530000N";
  std::string longitude = "0270000E";

  int rows() const { return level == 0 ? 121 : level == 1 ? 1201 : 3601; }
  int columns() const { return 36000 / column_spacing_tenths + 1; }

  /// Row 0 is the southernmost; -32767 is a void.
  std::string bytes(const std::function<int(int, int)>& height_m) const {
    std::string text(3428, ' ');
    const auto put = [&](std::size_t at, const std::string& what) {
      text.replace(at, what.size(), what);
    };
    const auto digits = [](int number) { return std::to_string(10000 + number).substr(1); };
    put(0, "UHL1" + longitude + latitude + digits(column_spacing_tenths) +
               digits(36000 / (rows() - 1)));
    put(47, digits(columns()) + digits(rows()));
    put(80, "DSI");
    put(728, "ACC");
    for (int column = 0; column < columns(); ++column) text += record(column, height_m);
    return text;
  }

 private:
  std::string record(int column, const std::function<int(int, int)>& height_m) const {
    std::string record("\xAA\0\0\0", 4);
    const auto put = [&](int value) {
      record += static_cast<char>(value >> 8 & 0xFF);
      record += static_cast<char>(value & 0xFF);
    };
    record[2] = static_cast<char>(column >> 8);
    record[3] = static_cast<char>(column);
    put(column);
    put(0);
    for (int row = 0; row < rows(); ++row) {
      const int height = height_m(row, column);
      put(height < 0 ? 0x8000 - height : height);
    }
    unsigned sum = 0;
    for (const char byte : record) sum += static_cast<unsigned char>(byte);
    put(static_cast<int>(sum >> 16));
    put(static_cast<int>(sum & 0xFFFF));
    return record;
  }
};

}  // namespace skein::navigation::testing
