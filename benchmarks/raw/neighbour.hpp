#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>

#include "raw/message.hpp"
#include "skein/error.hpp"

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

/// The peers that have been heard of, oneself among them. Thread-safe.
class Census {
 public:
  void add(const ClientId& peer) {
    std::lock_guard lock(mutex_);
    known_.insert(peer);
    changed_.notify_all();
  }

  void await(std::size_t count, std::chrono::seconds patience) {
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, patience, [&] { return known_.size() >= count; })) return;
    throw Internal("heard of " + std::to_string(known_.size()) + " of " + std::to_string(count) +
                   " peers");
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<ClientId> known_;
};

}  // namespace skein::benchmarks::raw
