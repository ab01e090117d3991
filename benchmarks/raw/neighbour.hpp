#pragma once

#include <cstddef>

#include "harness/census.hpp"
#include "raw/main.hpp"
#include "raw/message.hpp"

/// A raw peer with the endpoints of a Skein entity that provides one service: it announces itself
/// on a topic that all read, and is ready once it has read all others' announcements.
namespace skein::benchmarks::raw {

/// A description of the benchmark's service takes about as many octets.
inline constexpr std::size_t kAnnouncementBytes = 400;

inline constexpr const char* kAnnouncementTopic = "benchmark_raw_Announcement";
inline constexpr const char* kLoadTopic = "benchmark_raw_Load";
inline constexpr const char* kStatisticsTopic = "benchmark_raw_Statistics";
inline constexpr const char* kDecisionsTopic = "benchmark_raw_Decisions";
inline constexpr const char* kCallsTopic = "benchmark_raw_Calls";
inline constexpr const char* kCallRecordsTopic = "benchmark_raw_CallRecords";
inline constexpr const char* kQuestionsTopic = "benchmark_raw_Questions";
inline constexpr const char* kAnswersTopic = "benchmark_raw_Answers";

/// By the announcements.
using Heard = Census<ClientId>;

/// One of `options.peers` on that vendor.
void fastdds_neighbour(const RawOptions& options);
void cyclonedds_neighbour(const RawOptions& options);

}  // namespace skein::benchmarks::raw
