#pragma once

#include <deque>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <unordered_map>

#include "inline_watch.hpp"
#include "skein/entity/decision_topic.hpp"
#include "skein/entity/head.hpp"

namespace skein {

/// What a Head holds from one request to the next. Thread-safe.
struct Head::State {
  State(const Parts& parts, HeadOptions options);

  std::shared_ptr<const SelectionStrategy> strategy() const;
  /// Those that stand by; perhaps none.
  std::vector<Candidate> candidates(const InterfaceInfo& interface, const std::string& only,
                                    const Features& features, Instant now);
  /// Throws NoCandidate: there is none.
  [[noreturn]] void refuse_without(const InterfaceInfo& interface, const std::string& only) const;
  Situation situation(const InterfaceInfo& interface, const Features& features,
                      Duration remaining) const;
  /// Waits no longer than `patience` for a new connection; `now` is the time when it stands.
  std::shared_ptr<Channel> channel_to(const Candidate& candidate, Duration patience, Instant& now);

  struct Beginning {
    std::uint64_t run = 0;
    /// How many CSPs may run on their callers' threads for this one to be among them; none where it
    /// has a thread of its own in any case.
    std::size_t room_inline = 0;
  };

  /// A CSP begins to work, with so much time; nothing, and nothing happens, where it has been
  /// quarantined since it was listed.
  std::optional<Beginning> begin(const InterfaceInfo& interface, const Candidate& candidate,
                                 Instant now, Duration time);
  /// What came of it: for the breaker, the history, and whoever is told of hangs.
  void end(const InterfaceInfo& interface, const Candidate& candidate, const Features& features,
           std::uint64_t run, const Attempt& attempt, bool fault);
  /// It hung on its caller's thread: it is quarantined at once, and has its own thread for good.
  void distrust(const InterfaceInfo& interface, const Candidate& candidate);
  /// Numbers the decision, keeps it and tells of it; a copy to whom `wanted` belongs, if anybody.
  void conclude(DecisionRecord&& record, DecisionRecord* wanted = nullptr);
  std::size_t count_stuck();

  /// What is held of a CSP by its name.
  struct Standing {
    CircuitBreaker breaker;
    bool hung = false;  ///< It was late once, in this process.
  };

  /// A CSP as its description tells of it.
  struct Known {
    Candidate candidate;
    std::weak_ptr<rpc::Service> service;  ///< In this process.
    const Standing* standing;
  };

  /// The CSPs of an interface, for as long as the Broker's table stays as it is.
  struct Roster {
    std::uint64_t generation = UINT64_MAX;
    std::vector<Known> csps;
  };

  struct Running {
    std::uint64_t run;
    std::string csp;
    std::uint32_t pid;
  };

  const Parts parts;
  const HeadOptions options;
  const std::string host;  // looking it up reads a file
  const std::shared_ptr<entity::InlineWatch> watch;
  mutable std::mutex mutex;
  StrategyFactory strategies;
  History history;
  std::map<std::pair<std::string, std::string>, Standing, ByCsp> standings;
  std::unordered_map<const InterfaceInfo*, Roster> rosters;
  std::map<Guid, std::shared_ptr<Channel>> channels;
  std::vector<Running> running;
  std::set<Guid> hung;  // in this process, and perhaps back since
  bool was_degraded = false;
  std::uint64_t last_run = 0;
  std::uint64_t last_decision = 0;
  std::deque<DecisionRecord> decisions;
  std::mutex log_mutex;
  std::ofstream log_file;
  introspection::DecisionTopic topic;

 private:
  const Roster& roster(const InterfaceInfo& interface);
  Known known(const InterfaceInfo& interface,
              const brokerless_discovery::ServiceDescription& description);
  Standing& standing(std::string_view interface, std::string_view csp);
  std::size_t room_inline(const Candidate& candidate, const Standing& standing,
                          Duration time) const;
  void learn(const InterfaceInfo& interface, const Candidate& candidate, const Features& features,
             const Attempt& attempt);
  std::size_t stuck();
  void write_log(const DecisionRecord& record);
};

}  // namespace skein
