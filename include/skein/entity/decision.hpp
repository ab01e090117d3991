#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/entity/selection.hpp"

namespace skein {

namespace introspection {
struct Decision;
}

/// One CSP's try at a task.
struct Attempt : Choice {
  enum class Outcome {
    Accepted,
    Rejected,      ///< By the evaluation.
    Refused,       ///< With an exception that the interface declares.
    TimedOut,      ///< It had its slice and did not answer.
    Disconnected,  ///< It crashed or left while it worked.
    Failed,        ///< With any other error.
    Cancelled,     ///< Others were enough.
    Preselected,   ///< The Body calls it itself.
  };
  std::uint32_t round = 0;  ///< Its candidate's.
  Duration began{};         ///< After the decision began.
  Duration took{};
  Outcome outcome = Outcome::Failed;
  std::string check;  ///< Which check rejected the result.
  std::string text;   ///< What the check or the CSP said.
  std::optional<double> quality;
};

const char* to_string(Attempt::Outcome outcome) noexcept;

/// How one request was decided, with all that the choices rested on.
struct DecisionRecord {
  std::string entity;  ///< Whose Head: `system/name`.
  std::uint64_t number = 0;
  std::uint64_t time = 0;  ///< Nanoseconds since 1970, when it was made.
  std::string request;     ///< The Body's name for it.
  std::string interface;
  std::string strategy;
  std::string execution;
  Situation situation;  ///< As at the beginning.
  Duration available{};
  std::vector<Candidate>
      candidates;                 ///< As they stood by when they were looked for, round by round.
  std::vector<Attempt> attempts;  ///< As they began.
  std::string synthesis;          ///< How the result was made of several.
  std::string failure;            ///< Why there was no result; empty where there was.
  Duration took{};
  std::size_t stuck = 0;  ///< CSPs in this process that do not return.
};

/// Makes a record's choices again, from what it says that was known. They are those of its
/// attempts, bit for bit, where the strategy has not changed since. Throws InvalidArgument for a
/// strategy that is not there, and for a record that contradicts itself.
std::vector<Choice> replay(const DecisionRecord& record, const StrategyFactory& strategies = {});

/// The decision in plain words, several lines.
std::string explain(const DecisionRecord& record);

/// As it travels and as it stands in a log, and back. record_of() throws InvalidArgument for words
/// that it does not know.
introspection::Decision report_of(const DecisionRecord& record);
DecisionRecord record_of(const introspection::Decision& report);

}  // namespace skein
