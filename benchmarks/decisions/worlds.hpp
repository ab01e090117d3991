#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "navigation/grid/grid_map.hpp"
#include "navigation/terrain/terrain.hpp"
#include "navigator.idl.hpp"

namespace skein::benchmarks {

/// The side of a cell.
inline constexpr double kCellM = 100;

/// Flat land, and no-fly zones on it that are made of whole cells.
struct World {
  std::string kind;
  std::shared_ptr<const navigation::grid::GridMap> map;  ///< Blocked where a zone is.
  std::vector<AE_navigator::NoFlyZone> zones;            ///< A rectangle each.
  std::shared_ptr<const navigation::Terrain> terrain;    ///< Whose name is the world's.
};

/// A number below `limit`, and one from 0 to 1: the same on every machine.
int below(int limit, std::mt19937& random);
double share(std::mt19937& random);

/// A square of `size` cells a side: `open` (scattered blocks), `rooms` (walls with doors of one or
/// two cells), `maze` (eight by eight rooms, one way between any two). The same seed makes the same
/// world. Throws InvalidArgument for another kind.
World make_world(const std::string& kind, int size, std::uint32_t seed);

/// A map of movingai.com. Throws what navigation::grid::read_grid_map() throws.
World read_world(const std::filesystem::path& file);

/// The middle of a cell, 300 m above the land.
AE_navigator::Position middle_of(const navigation::grid::Cell& cell);

}  // namespace skein::benchmarks
