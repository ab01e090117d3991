#pragma once

#include <cstddef>
#include <string>

#include "harness/census.hpp"
#include "raw/main.hpp"
#include "raw/message.hpp"
#include "rpc/service/introspection_topic.hpp"

/// A raw peer with the endpoints of a Skein entity that provides one service: it announces itself
/// on a topic that all read, and is ready once it has read all others' announcements.
namespace skein::benchmarks::raw {

/// A description of the benchmark's service takes about as many octets.
inline constexpr std::size_t kAnnouncementBytes = 400;

inline constexpr const char* kAnnouncementTopic = "benchmark_raw_Announcement";
inline constexpr const char* kLoadTopic = "benchmark_raw_Load";
inline constexpr const char* kQuestionsTopic = "benchmark_raw_Questions";
inline constexpr const char* kAnswersTopic = "benchmark_raw_Answers";

/// Calls `make` with the name and the reliability of each topic on which an entity tells of itself.
template <class Make>
void for_each_introspection_topic(const Make& make) {
  introspection::for_each_topic([&](const introspection::AnyTopic& topic) {
    make("benchmark_raw_" + std::string(topic.name), topic.reliable);
  });
}

/// By the announcements.
using Heard = Census<ClientId>;

/// One of `options.peers` on that vendor.
void fastdds_neighbour(const RawOptions& options);
void cyclonedds_neighbour(const RawOptions& options);

}  // namespace skein::benchmarks::raw
