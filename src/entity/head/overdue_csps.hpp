#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "head_warnings.hpp"
#include "skein/clock.hpp"
#include "skein/guid.hpp"
#include "skein/selection.hpp"

namespace skein::entity {

/// Logs and counts CSPs in this process that do not return although their request's time is over.
/// Thread-safe.
class OverdueCsps {
 public:
  /// Asks about a provider in this process.
  struct Providers {
    std::function<bool(const Guid&)> is_overdue;
    /// Whether blocking calls run on their callers' threads.
    std::function<bool(const Guid&)> runs_on_caller;
  };

  /// `most`: as HeadOptions::max_stuck.
  OverdueCsps(std::string entity, Clock& clock, std::size_t most, Providers providers,
              HeadWarnings& warnings);
  ~OverdueCsps();

  /// While it lives, this thread may run a CSP, and then cannot log itself that the CSP does not
  /// return: that is logged after `end`, at most a second later.
  class Watch {
   public:
    Watch(OverdueCsps& csps, const InterfaceInfo& interface, const Candidate& candidate,
          Instant end);
    ~Watch();
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

   private:
    friend OverdueCsps;
    OverdueCsps& csps_;
    const std::string_view interface_;
    const Candidate& candidate_;
    const Instant end_;
  };

  /// The CSP did not answer in time; perhaps it has since. Logged at the next count if it `hangs`,
  /// otherwise at the one after that, if it has not returned by then.
  void add(const InterfaceInfo& interface, const Candidate& candidate, bool hangs);

  /// How many have not returned by now. Logs them, and an error when they become as many as `most`.
  std::size_t count();

 private:
  struct Overdue {
    std::string_view interface;
    std::string csp;
    bool tell;
  };

  void arm(Instant next_end);
  void look();

  const std::string entity_;
  Clock& clock_;
  const std::size_t most_;
  const Providers providers_;
  HeadWarnings& warnings_;
  std::mutex mutex_;
  std::map<Guid, Overdue> overdue_;
  bool was_degraded_ = false;
  std::vector<const Watch*> watches_;
  TimerId timer_ = 0;  // armed while the end of a watch is to come, and for the next round
};

}  // namespace skein::entity
