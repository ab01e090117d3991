#pragma once

#include <string>
#include <vector>

#include "harness/comparison.hpp"

namespace skein::benchmarks {

/// A table of all goals, as HTML: where each came off worst in this run, and whether it was met.
std::string goals_section(const std::vector<Comparison>& comparisons);

/// The same in Markdown, shorter: what README quotes.
std::string goals_table(const std::vector<Comparison>& comparisons);

/// Writes that into a file. Throws Error where it cannot be written.
void write_goals(const std::vector<Comparison>& comparisons, const std::string& path);

}  // namespace skein::benchmarks
