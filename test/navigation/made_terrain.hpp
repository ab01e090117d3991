#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "skein/navigation/terrain.hpp"
#include "skein/navigation/terrain_provider.hpp"

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

/// A folder of its own that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "skein-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

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

}  // namespace skein::navigation::testing
