#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include "skein/guid.hpp"

namespace skein::dds::fastdds {

/// Decides when a participant has not been heard of for its lease (watch()), and whether its
/// writers count as alive (alive()).
///
/// Fast DDS supervises both itself, and crashes: the timer of its readers' liveliness walks the
/// list of local readers without a lock, and the timer of a participant's lease works on a proxy
/// that a receiving thread is just clearing or using again. So no reader tells Fast DDS of a lease,
/// the leases of participants are put off before it reads them (put_off_leases.hpp), and what
/// the transport receives is watched here instead.
///
/// Time counts only while it is watched: a pause between two calls of watch() that is much longer
/// than the one asked for says that this process did not run, and that others' packets may
/// wait in its sockets. Thread-safe.
class FastLeaseWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::nanoseconds;

  /// Begins to follow a participant, heard of just now; or changes its lease. Nothing: it never
  /// runs out.
  void follow(const Guid& participant, std::optional<Duration> lease, Time now);
  void forget(const Guid& participant);

  /// Notes that a message of that participant came. Whether it is one that had been forgotten and
  /// has just come back.
  bool heard(const Guid& participant, Time now);

  /// Lets the time pass; to be called each `period`. Returns those whose lease has run out, each
  /// once.
  std::vector<Guid> watch(Time now, Duration period);

  /// All that are followed, and follows them no more.
  std::vector<Guid> drop_all();

  /// Whether a participant that is followed was heard of in the last `lease`; true for others.
  bool alive(const Guid& participant, Duration lease, Time now) const;

 private:
  Duration::rep counted(Time now) const;

  struct Followed {
    std::atomic<Duration::rep> last{0};  // in the time that counts
    std::atomic<Duration::rep> lease{0};
  };

  mutable std::shared_mutex mutex_;
  std::unordered_map<Guid, Followed> followed_;
  /// Forgotten; when heard of again, or 0.
  std::unordered_map<Guid, std::atomic<Duration::rep>> returned_;
  std::atomic<Duration::rep> pauses_{0};  // how long in all
  std::mutex watching_;
  Time last_watch_{};  // under watching_
};

}  // namespace skein::dds::fastdds
