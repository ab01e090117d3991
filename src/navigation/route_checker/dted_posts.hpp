#pragma once

#include <filesystem>
#include <vector>

namespace skein::navigation {

/// A tile of one degree by one degree, or several, as they are stored, voids (-32768) included.
struct TilePosts {
  int southern_latitude_deg = 0;
  int western_longitude_deg = 0;
  int degrees_north = 1;
  int degrees_east = 1;
  int rows = 0;
  int columns = 0;
  std::vector<float> heights_m;  ///< Row by row, the southernmost first.
};

/// The checker's own reading of a DTED tile: it trusts the reader of planners with headers and
/// checksums, but with no height. Throws InvalidArgument for a file that is cut off.
TilePosts read_dted_posts(const std::filesystem::path& file);

}  // namespace skein::navigation
