#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "head_warnings.hpp"
#include "skein/head.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::entity {

/// How a run of a CSP ended.
struct RunEnding {
  introspection::Outcome outcome{};
  Duration took{};
  Duration expected{};  ///< As Selection::expected.
  std::optional<double> quality{};
  bool fault = false;
  bool settled = false;       ///< A refusal that is the answer.
  bool own = false;           ///< As Verdict::own.
  std::string reason{};       ///< Of a fault, in words.
  std::uint64_t request = 0;  ///< Its number.
  std::uint32_t after = 0;    ///< As History::Sample::after.
};

/// The CSPs that work for a Head now, and the circuit breakers that keep work from CSPs that fail.
/// Thread-safe.
class RunningCsps {
 public:
  RunningCsps(Clock& clock, const CircuitBreaker::Rules& rules, HeadWarnings& warnings)
      : clock_(clock), rules_(rules), warnings_(warnings) {}

  /// Says of each candidate whether it is in quarantine.
  void note_quarantine(const InterfaceInfo& interface, std::vector<Candidate>& candidates,
                       Instant now) const;

  /// A CSP begins to work: returns the number of its run. Returns nullopt and starts nothing if the
  /// CSP has been quarantined since it was listed.
  std::optional<std::uint64_t> begin(const InterfaceInfo& interface, const Candidate& candidate,
                                     std::shared_ptr<const std::string> host, Instant now);

  /// Ends the run. A fault counts against the CSP; one that `hangs` is quarantined at its first.
  /// Logs the beginning of a quarantine.
  void end(const InterfaceInfo& interface, const Candidate& candidate, std::uint64_t run,
           const RunEnding& ending, bool hangs);

  std::vector<Head::Current> list() const;

 private:
  struct Running {
    std::uint64_t run;
    std::string csp;
    std::uint32_t pid;
    std::shared_ptr<const std::string> host;  // null if it has just left
  };

  CircuitBreaker& breaker(std::string_view interface, std::string_view csp);

  Clock& clock_;
  const CircuitBreaker::Rules rules_;
  HeadWarnings& warnings_;
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, CircuitBreaker, ByCsp> breakers_;
  std::vector<Running> running_;
  std::uint64_t last_run_ = 0;
};

}  // namespace skein::entity
