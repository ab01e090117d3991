#pragma once

#include <filesystem>
#include <vector>

#include "decisions/scores.hpp"

namespace skein::benchmarks {

/// A row a request: what it was, what the Head with `learned` chose and how that ended, the virtual
/// best, the single best, and the time and outcome of every contestant. `quality` is the length of
/// the shortest valid route to this request by that of the answer. Throws Internal where the file
/// cannot be written.
void write_decision_table(const std::vector<Trial>& trials, const std::filesystem::path& file);

}  // namespace skein::benchmarks
