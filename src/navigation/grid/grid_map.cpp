#include "navigation/grid/grid_map.hpp"

#include <limits>
#include <string>

#include "skein/error.hpp"

namespace skein::navigation::grid {

GridMap::GridMap(int width, int height, int depth) : width_(width), height_(height), depth_(depth) {
  const double cells = static_cast<double>(width) * height * depth;
  if (width < 1 || height < 1 || depth < 1 || cells > std::numeric_limits<std::int32_t>::max()) {
    throw InvalidArgument("there is no map of " + std::to_string(width) + " x " +
                          std::to_string(height) + " x " + std::to_string(depth) +
                          " cells; each side is at least 1, and there are less than 2^31 cells");
  }
  blocked_.assign(bit_of({width - 1, height - 1, depth - 1}) / 64 + 1, 0);
}

}  // namespace skein::navigation::grid
