#pragma once

namespace skein::benchmarks {

/// decisions/instances.csv and selection/random_forest.csv, where the project's sources lie.
extern const char* const kDecisionInstances;
extern const char* const kRandomForestGaps;

}  // namespace skein::benchmarks
