#pragma once

namespace skein::benchmarks {

/// decisions/instances.csv, selection/random_forest.csv and selection/aslib.py, where the project's
/// sources lie.
extern const char* const kDecisionInstances;
extern const char* const kRandomForestGaps;
extern const char* const kAslibReader;

}  // namespace skein::benchmarks
