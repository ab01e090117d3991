#pragma once

#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "navigator.idl.hpp"
#include "skein/head.hpp"

namespace skein::navigation {

/// One of the decisions on a request, and the threats that it rested on.
struct Planning {
  std::uint32_t threat_epoch = 0;
  introspection::Decision record;
};

/// What the navigator remembers of its requests: those that it works on, and how the last 64 were
/// decided. Thread-safe.
class PlanningJournal {
 public:
  void begin(const std::string& request_id);

  /// Makes the report of the request from the Head's records, one for each time that it planned.
  /// `failure` is what ended the request.
  void end(const std::string& request_id, const std::vector<Planning>& plannings,
           const std::string& failure);

  /// The request that began last of those at work; empty if there is none.
  std::string current() const;

  /// Requests at work.
  std::size_t at_work() const;

  /// Throws UnknownRequest.
  AE_navigatorI::PlanningReport report(const std::string& request_id) const;

 private:
  void add_absent(AE_navigatorI::PlanningReport& report) const;

  mutable std::mutex mutex_;
  std::deque<std::string> at_work_;
  std::deque<AE_navigatorI::PlanningReport> reports_;
  /// Every planner that was ever seen, so that reports can say who is missing.
  std::map<std::string, AE_navigatorI::PlannerCandidate> known_;
};

}  // namespace skein::navigation
