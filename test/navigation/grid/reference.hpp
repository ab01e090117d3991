#pragma once

#include <optional>
#include <random>

#include "navigation/grid/grid_planner.hpp"

namespace skein::navigation::grid::testing {

/// Whether the move between neighbours is allowed, by the words of GridMap alone.
bool allowed(const GridMap& map, const Cell& from, const Cell& to);

/// Lengths of the shortest paths from `start` to every cell, by Dijkstra over all that is allowed;
/// infinite where there is none. In the order x, then y, then z.
std::vector<double> shortest_lengths(const GridMap& map, const Cell& start);
double length_at(const GridMap& map, const std::vector<double>& lengths, const Cell& cell);

/// What is wrong with a path on the grid: its ends, its moves or its length. Empty where nothing
/// is.
std::string fault_of(const GridMap& map, const GridPath& path, const Cell& start, const Cell& goal);

/// Each cell blocked with the probability `density`.
GridMap random_map(int width, int height, int depth, double density, std::mt19937_64& random);
Cell random_cell(const GridMap& map, std::mt19937_64& random);

}  // namespace skein::navigation::grid::testing
