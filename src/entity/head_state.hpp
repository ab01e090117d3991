#pragma once

#include <deque>
#include <fstream>
#include <map>
#include <mutex>
#include <set>

#include "skein/entity/decision_topic.hpp"
#include "skein/entity/head.hpp"

namespace skein {

/// What a Head holds from one request to the next. Thread-safe.
struct Head::State {
  State(const Parts& parts, HeadOptions options);

  std::shared_ptr<const SelectionStrategy> strategy() const;
  /// Those that stand by; perhaps none.
  std::vector<Candidate> candidates(const InterfaceInfo& interface, const std::string& only,
                                    const Features& features);
  /// Throws NoCandidate: there is none.
  [[noreturn]] void refuse_without(const InterfaceInfo& interface, const std::string& only) const;
  Situation situation(const InterfaceInfo& interface, const Features& features,
                      Duration remaining) const;
  std::shared_ptr<Channel> channel_to(const Candidate& candidate, Duration timeout);

  /// A CSP begins to work; false, and nothing happens, where it has been quarantined since it was
  /// listed.
  bool begin(const InterfaceInfo& interface, const Candidate& candidate, std::uint64_t& run);
  /// What came of it: for the breaker, the history, and whoever is told of hangs.
  void end(const InterfaceInfo& interface, const Candidate& candidate, const Features& features,
           std::uint64_t run, const Attempt& attempt, bool fault);
  /// Numbers the decision, keeps it and tells of it.
  void conclude(DecisionRecord& record);
  std::size_t count_stuck();

  const Parts parts;
  const HeadOptions options;
  const std::string host;  // looking it up reads a file
  mutable std::mutex mutex;
  StrategyFactory strategies;
  History history;
  std::map<std::pair<std::string, std::string>, CircuitBreaker> breakers;  // by interface and CSP
  std::map<Guid, std::shared_ptr<Channel>> channels;
  std::map<std::uint64_t, Current> running;
  std::set<Guid> hung;  // in this process, and perhaps back since
  bool was_degraded = false;
  std::uint64_t last_run = 0;
  std::uint64_t last_decision = 0;
  std::deque<DecisionRecord> decisions;
  std::mutex log_mutex;
  std::ofstream log_file;
  introspection::DecisionTopic topic;

 private:
  Candidate candidate_of(const InterfaceInfo& interface,
                         const brokerless_discovery::ServiceDescription& description,
                         bool in_process, const Features& features, Instant now) const;
  CircuitBreaker& breaker(const InterfaceInfo& interface, const Candidate& candidate);
  void learn(const InterfaceInfo& interface, const Candidate& candidate, const Features& features,
             const Attempt& attempt);
  void write_log(const DecisionRecord& record);
};

}  // namespace skein
