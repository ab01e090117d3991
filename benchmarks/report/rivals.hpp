#pragma once

#include <string>
#include <vector>

#include "harness/comparison.hpp"
#include "report/sections.hpp"

/// The parts of the report about other middleware.
namespace skein::benchmarks {

/// What tells a comparison from others of its claim, placement aside: `1 KiB`, `32 clients`.
std::string variant_of(const Comparison& comparison);

/// Whether a comparison is one of a matrix: many rivals, at fixed placements.
bool is_of_matrix(const Comparison& comparison);

/// One sentence for each claim, variant, placement and subject: behind whom and ahead of whom.
std::string rivals_verdict(const std::vector<Comparison>& comparisons);

/// All contenders by variant, one table a placement.
std::string section_of_rivals(const std::string& claim, const Comparisons& comparisons);

}  // namespace skein::benchmarks
