#include "decisions/worlds.hpp"

#include <array>

#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

using navigation::grid::Cell;
using navigation::grid::GridMap;

constexpr double kAltitudeM = 300;
constexpr double kCeilingM = 10'000;

void block(GridMap& map, int x, int y, int width, int height) {
  for (int row = y; row < y + height; ++row) {
    for (int column = x; column < x + width; ++column) {
      if (map.contains({column, row})) map.block({column, row});
    }
  }
}

GridMap open_land(int size, std::mt19937& random) {
  GridMap map(size, size);
  for (int i = 0; i < size / 3; ++i) {
    const int width = 1 + below(size / 10, random);
    const int height = 1 + below(size / 10, random);
    const int x = below(size, random);
    block(map, x, below(size, random), width, height);
  }
  return map;
}

GridMap rooms(int size, std::mt19937& random) {
  GridMap map(size, size);
  const int side = size / 4;
  for (int wall = 1; wall < 4; ++wall) {
    for (int room = 0; room < 4; ++room) {
      for (const bool upright : {false, true}) {
        const int width = 1 + below(2, random);
        const int door = room * side + 1 + below(side - width - 1, random);
        for (int i = room * side; i < (room + 1) * side; ++i) {
          if (i >= door && i < door + width) continue;
          map.block(upright ? Cell{wall * side, i} : Cell{i, wall * side});
        }
      }
    }
  }
  return map;
}

/// Walks from room to room, always on to one where it has not been, and opens the wall between.
class Maze {
 public:
  Maze(int size, std::mt19937& random) : side_(size / kRooms), map_(size, size), random_(random) {
    walk(0, 0);
    for (int y = 0; y < kRooms; ++y) {
      for (int x = 0; x < kRooms; ++x) wall(x, y);
    }
  }
  const GridMap& map() const { return map_; }

 private:
  static constexpr int kRooms = 8;
  struct Room {
    bool visited = false, open_right = false, open_below = false;
  };

  Room& room(int x, int y) {
    return rooms_[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
  }

  void walk(int x, int y) {
    room(x, y).visited = true;
    std::array<Cell, 4> ways{Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}};
    for (int left = 4; left > 0; --left) {
      std::swap(ways[static_cast<std::size_t>(below(left, random_))],
                ways[static_cast<std::size_t>(left) - 1]);
      const Cell way = ways[static_cast<std::size_t>(left) - 1];
      const int to_x = x + way.x, to_y = y + way.y;
      if (to_x < 0 || to_y < 0 || to_x >= kRooms || to_y >= kRooms) continue;
      if (room(to_x, to_y).visited) continue;
      if (way.x != 0) room(std::min(x, to_x), y).open_right = true;
      if (way.y != 0) room(x, std::min(y, to_y)).open_below = true;
      walk(to_x, to_y);
    }
  }

  void wall(int x, int y) {
    const int right = (x + 1) * side_ - 1, bottom = (y + 1) * side_ - 1;
    if (x + 1 < kRooms && !room(x, y).open_right) block(map_, right, y * side_, 1, side_);
    if (y + 1 < kRooms && !room(x, y).open_below) block(map_, x * side_, bottom, side_, 1);
  }

  const int side_;
  GridMap map_;
  std::mt19937& random_;
  std::array<std::array<Room, kRooms>, kRooms> rooms_{};
};

AE_navigator::NoFlyZone zone(int x, int y, int width, int height) {
  const double south = y * kCellM, west = x * kCellM;
  const double north = (y + height) * kCellM, east = (x + width) * kCellM;
  return {"wall", {{south, west}, {south, east}, {north, east}, {north, west}}, 0, 0, kCeilingM};
}

/// The blocked cells as rectangles: each as wide as it goes, then as high.
std::vector<AE_navigator::NoFlyZone> zones_of(const GridMap& map) {
  GridMap done(map.width(), map.height());
  const auto left = [&](int x, int y) {
    const Cell cell{x, y};
    return map.contains(cell) && !map.is_free(cell) && done.is_free(cell);
  };
  std::vector<AE_navigator::NoFlyZone> zones;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (!left(x, y)) continue;
      int width = 1, height = 1;
      while (left(x + width, y)) ++width;
      const auto row_left = [&](int row) {
        for (int i = 0; i < width; ++i) {
          if (!left(x + i, row)) return false;
        }
        return true;
      };
      while (row_left(y + height)) ++height;
      block(done, x, y, width, height);
      zones.push_back(zone(x, y, width, height));
    }
  }
  return zones;
}

World world_of(std::string kind, const std::string& name, GridMap map) {
  World world{std::move(kind), nullptr, zones_of(map), nullptr};
  const auto posts = [](int cells) { return static_cast<std::size_t>(cells) + 1; };
  world.terrain = std::make_shared<const navigation::Terrain>(
      name, map.height() + 1, map.width() + 1, kCellM, kCellM,
      std::vector<float>(posts(map.height()) * posts(map.width()), 0));
  world.map = std::make_shared<const GridMap>(std::move(map));
  return world;
}

}  // namespace

// Engines, unlike distributions, give the same numbers with every library.
int below(int limit, std::mt19937& random) {
  return static_cast<int>(random() % static_cast<std::uint32_t>(limit));
}

double share(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

World make_world(const std::string& kind, int size, std::uint32_t seed) {
  std::mt19937 random(seed);
  const std::string name = kind + ":" + std::to_string(size) + ":" + std::to_string(seed);
  if (kind == "open") return world_of(kind, name, open_land(size, random));
  if (kind == "rooms") return world_of(kind, name, rooms(size, random));
  if (kind == "maze") return world_of(kind, name, Maze(size, random).map());
  throw InvalidArgument("there is no kind of world '" + kind + "'; there are open, rooms and maze");
}

World read_world(const std::filesystem::path& file) {
  return world_of("recorded", file.filename().string(), navigation::grid::read_grid_map(file));
}

AE_navigator::Position middle_of(const navigation::grid::Cell& cell) {
  return {(cell.y + 0.5) * kCellM, (cell.x + 0.5) * kCellM, kAltitudeM};
}

}  // namespace skein::benchmarks
