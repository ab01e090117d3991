#pragma once

namespace skein::benchmarks {

/// decisions/instances.csv, selection/random_forest.csv, selection/aslib.py and report.py, where
/// the project's sources lie.
extern const char* const kDecisionInstances;
extern const char* const kRandomForestGaps;
extern const char* const kAslibReader;
extern const char* const kReport;

}  // namespace skein::benchmarks
