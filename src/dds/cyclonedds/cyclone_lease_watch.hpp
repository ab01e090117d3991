#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_guid.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "skein/guid.hpp"

struct ddsi_domaingv;

namespace skein::dds::cyclonedds {

/// Decides when a participant has not been heard of for its lease. Cyclone looks at the clock
/// alone: on a machine that has too much to do, where what a participant sent waits to be read, all
/// participants forget each other, and the work of finding each other again keeps the machine too
/// busy for ever. Here silence is forgiven as far as this process itself came late.
///
/// It reaches into Cyclone 0.10, where a participant's lease is known to its own thread alone until
/// the listener for participants has returned.
class CycloneLeaseWatch {
 public:
  explicit CycloneLeaseWatch(ddsi_domaingv& domain);
  /// Waits for its thread. Before Cyclone's domain goes.
  ~CycloneLeaseWatch();

  /// From the listener that is told of a participant; gives its lease into this watch's hands.
  void found(const Guid& participant);
  void lost(const Guid& participant);

 private:
  using Clock = std::chrono::steady_clock;

  /// Endpoints of a participant that was given up; some may be left over for a while.
  struct GivenUp {
    std::vector<ddsi_guid_t> endpoints;
    Clock::time_point until;
  };

  void run();
  void give_up(const Guid& participant);
  void delete_left_over();
  std::chrono::nanoseconds silence_of(const Guid& participant);
  /// When the next one may be due.
  std::chrono::nanoseconds check(std::chrono::nanoseconds forgiven);

  ddsi_domaingv& domain_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::map<Guid, std::chrono::nanoseconds> leases_;
  std::map<Guid, GivenUp> given_up_;  // the thread's
  std::thread thread_;
};

}  // namespace skein::dds::cyclonedds
