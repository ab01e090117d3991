#pragma once

#include <string>
#include <vector>

#include "harness/comparison.hpp"

/// The parts of the report, as HTML.
namespace skein::benchmarks {

using Comparisons = std::vector<const Comparison*>;

/// `1 KiB`.
std::string size_text(std::size_t size_bytes);

/// How the page's style calls it.
inline const char* class_of(const Absence& absence) { return absence.failed ? "bad" : "skipped"; }

/// What tells a comparison from others of its claim: `1 KiB, one core each`.
std::string place_of(const Comparison& comparison);

/// Verdicts in words: every comparison beyond its goal, and what failed or was skipped.
std::string verdict_section(const std::vector<Comparison>& comparisons);

/// Latency by size, ratios and tails of one claim.
std::string section_by_size(const std::string& claim, const Comparisons& comparisons);

/// A claim whose figures are no times.
std::string section_of_figures(const std::string& claim, const Comparisons& comparisons);

/// Every measured time of one claim as a dot.
std::string section_of_times(const std::string& claim, const Comparisons& comparisons);

/// All figures of these comparisons, in columns.
std::string table_of(const Comparisons& comparisons);

}  // namespace skein::benchmarks
