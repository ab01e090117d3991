#include "line_reader.hpp"
#include "navigation/grid/grid_map.hpp"
#include "skein/error.hpp"

namespace skein::navigation::grid {
namespace {

/// A map of the sides that the file names, which must not be too large for a map.
GridMap map_of(const LineReader& in, int width, int height, int depth) {
  try {
    return GridMap(width, height, depth);
  } catch (const InvalidArgument& error) {
    in.refuse(error.what());
  }
}

int side(LineReader& in, const char* name) {
  if (!in.next_filled()) in.refuse(std::string("the file ends before '") + name + "'");
  const std::vector<std::string> words = in.words();
  if (words.size() != 2 || words[0] != name) {
    in.refuse("expected '" + std::string(name) + " <cells>', found '" + in.line() + "'");
  }
  return in.integer(words[1]);
}

void read_row(const LineReader& in, GridMap& map, int y) {
  if (static_cast<int>(in.line().size()) != map.width()) {
    in.refuse("the row has " + std::to_string(in.line().size()) + " cells instead of " +
              std::to_string(map.width()));
  }
  for (int x = 0; x < map.width(); ++x) {
    const char cell = in.line()[static_cast<std::size_t>(x)];
    if (std::string_view("@OTW").find(cell) != std::string_view::npos) {
      map.block({x, y});
    } else if (std::string_view(".GS").find(cell) == std::string_view::npos) {
      in.refuse(std::string("'") + cell + "' in column " + std::to_string(x) +
                " is no cell; free are '.', 'G', 'S', blocked '@', 'O', 'T', 'W'");
    }
  }
}

GridMap read_plane(LineReader& in) {
  const int height = side(in, "height");
  const int width = side(in, "width");
  GridMap map = map_of(in, width, height, 1);
  if (!in.next_filled() || in.words() != std::vector<std::string>{"map"}) {
    in.refuse("expected 'map' before the rows");
  }
  for (int y = 0; y < height; ++y) {
    if (!in.next()) {
      in.refuse("the file ends after " + std::to_string(y) + " of " + std::to_string(height) +
                " rows");
    }
    read_row(in, map, y);
  }
  if (in.next_filled()) in.refuse("there is more after the last row");
  return map;
}

GridMap read_space(LineReader& in, const std::vector<std::string>& sides) {
  GridMap map = map_of(in, in.integer(sides[1]), in.integer(sides[2]), in.integer(sides[3]));
  while (in.next_filled()) {
    const std::vector<std::string> words = in.words();
    if (words.size() != 3) in.refuse("expected a blocked cell 'x y z', found '" + in.line() + "'");
    const Cell cell{in.integer(words[0]), in.integer(words[1]), in.integer(words[2])};
    if (!map.contains(cell)) in.refuse("'" + in.line() + "' is outside the map");
    map.block(cell);
  }
  return map;
}

}  // namespace

GridMap read_grid_map(const std::filesystem::path& file) {
  LineReader in(file);
  in.next_filled();
  const std::vector<std::string> words = in.words();
  if (words == std::vector<std::string>{"type", "octile"}) return read_plane(in);
  if (words.size() == 4 && words[0] == "voxel") return read_space(in, words);
  in.refuse("a map begins with 'type octile' or 'voxel <width> <height> <depth>', not with '" +
            in.line() + "'");
}

}  // namespace skein::navigation::grid
