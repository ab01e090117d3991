#include <cmath>

#include "line_reader.hpp"
#include "navigation/grid/scenario.hpp"

namespace skein::navigation::grid {
namespace {

using Words = std::vector<std::string>;

/// Bucket, map, its width and height, start, goal, length.
Scenario plane_scenario(const LineReader& in, const Words& words, const GridMap& map) {
  if (words.size() != 9) in.refuse("expected 9 columns, found " + std::to_string(words.size()));
  if (in.integer(words[2]) != map.width() || in.integer(words[3]) != map.height()) {
    in.refuse("is meant for a map of " + words[2] + " x " + words[3] + " cells, this one has " +
              std::to_string(map.width()) + " x " + std::to_string(map.height()));
  }
  const auto at = [&](std::size_t column) { return in.integer(words[column]); };
  Scenario scenario{{at(4), at(5)}, {at(6), at(7)}, in.real(words[8])};
  if (scenario.length == 0 && scenario.start != scenario.goal) scenario.length.reset();
  return scenario;
}

/// Start, goal, length, and its ratio to the heuristic, which says nothing new.
Scenario space_scenario(const LineReader& in, const Words& words) {
  if (words.size() != 8) in.refuse("expected 8 columns, found " + std::to_string(words.size()));
  const auto at = [&](std::size_t column) { return in.integer(words[column]); };
  return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, in.real(words[6])};
}

}  // namespace

std::vector<Scenario> read_scenarios(const std::filesystem::path& file, const GridMap& map) {
  LineReader in(file);
  in.next_filled();
  const Words head = in.words();
  if (head.size() != 2 || head[0] != "version") in.refuse("scenarios begin with 'version 1'");
  if (!map.is_plane() && !in.next_filled()) in.refuse("the file ends before the map's name");
  std::vector<Scenario> scenarios;
  while (in.next_filled()) {
    const Words words = in.words();
    scenarios.push_back(map.is_plane() ? plane_scenario(in, words, map)
                                       : space_scenario(in, words));
    const Scenario& last = scenarios.back();
    if (!map.contains(last.start)) in.refuse("the start is outside the map");
    if (!map.contains(last.goal)) in.refuse("the goal is outside the map");
  }
  return scenarios;
}

bool is_recorded_result(const Scenario& scenario, std::optional<double> length) {
  if (!length || !scenario.length) return length.has_value() == scenario.length.has_value();
  return std::abs(*length - *scenario.length) <= kRecordedPrecision;
}

}  // namespace skein::navigation::grid
