#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/selection.hpp"

namespace skein {

namespace introspection {
struct Decision;
}

/// One attempt of a CSP at a task.
struct Attempt : Choice {
  enum class Outcome {
    Accepted,
    Rejected,      ///< Rejected by the evaluation.
    Refused,       ///< It threw an exception that the interface declares.
    TimedOut,      ///< It did not answer in time.
    Disconnected,  ///< It crashed or left during the call.
    Failed,        ///< Any other error.
    Cancelled,     ///< Not needed any more, or quarantined before it began.
    Preselected,   ///< Chosen for a Body that calls it itself.
  };
  std::uint32_t round = 0;  ///< As Candidate::round.
  Duration began{};         ///< Time from the start of the decision.
  Duration took{};
  Outcome outcome = Outcome::Failed;
  std::string check;  ///< The check that rejected the result.
  std::string text;   ///< The message of the check or the CSP.
  std::optional<double> quality;
};

const char* to_string(Attempt::Outcome outcome) noexcept;

/// How one request was decided, with everything that the choices were based on.
struct DecisionRecord {
  std::string entity;  ///< The Head's entity: `system/name`.
  std::uint64_t number = 0;
  std::uint64_t time = 0;  ///< When it began: nanoseconds since 1970.
  std::string request;     ///< As TaskOptions::request.
  std::string interface;
  std::string strategy;
  std::string execution;
  Situation situation;  ///< At the beginning.
  Duration available{};
  std::vector<Candidate> candidates;  ///< As they were when looked up, by round.
  std::vector<Attempt> attempts;      ///< In the order in which they began.
  std::string synthesis;              ///< How the result was made from several.
  std::string failure;                ///< Why there is no result; empty if there is one.
  Duration took{};
  std::size_t stuck = 0;  ///< CSPs in this process that do not return.
};

/// Makes a record's choices again, from what the record says was known. They equal the choices of
/// its attempts bit for bit, unless the strategy has changed. Throws InvalidArgument for an unknown
/// strategy and for an inconsistent record.
std::vector<Choice> replay(const DecisionRecord& record, const StrategyFactory& strategies = {});

/// The decision in plain words, in several lines.
std::string explain(const DecisionRecord& record);

/// Converts a record to the form that is published and logged, and back. record_of() throws
/// InvalidArgument for an unknown outcome or breaker state.
introspection::Decision report_of(const DecisionRecord& record);
DecisionRecord record_of(const introspection::Decision& report);

}  // namespace skein
