#pragma once

#include <filesystem>
#include <vector>

namespace skein::navigation {

/// The ground as the route checker sees it: raw heights of posts, nothing else. The checker reads
/// tiles itself; for an invented terrain the caller hands over its posts.
struct HeightGrid {
  int rows = 0;     ///< From south to north.
  int columns = 0;  ///< From west to east.
  double north_spacing_m = 0;
  double east_spacing_m = 0;
  std::vector<float> heights_m;  ///< Row by row, the southernmost first.
};

/// Reads SRTM tiles or a DTED tile without any code of the planners. Voids are as high as the
/// highest post beside them. Throws InvalidArgument, naming the file, where that cannot be done.
HeightGrid read_height_grid(const std::filesystem::path& file);

}  // namespace skein::navigation
