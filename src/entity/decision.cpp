#include "skein/decision.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "wire_values.hpp"

namespace skein {
namespace {

using Outcome = Attempt::Outcome;
using Breaker = CircuitBreaker::State;

constexpr std::array kOutcomes{Outcome::Accepted,  Outcome::Rejected,     Outcome::Refused,
                               Outcome::TimedOut,  Outcome::Disconnected, Outcome::Failed,
                               Outcome::Cancelled, Outcome::Preselected};
constexpr std::array kBreakers{Breaker::Closed, Breaker::Open, Breaker::HalfOpen};

template <class Enumeration, std::size_t kSize>
Enumeration named(const std::array<Enumeration, kSize>& all, const std::string& word,
                  const char* what) {
  for (const Enumeration each : all) {
    if (word == to_string(each)) return each;
  }
  throw InvalidArgument("a decision's record has the " + std::string(what) + " '" + word +
                        "', which is none");
}

introspection::LearnedFigures figures_of(const Prediction& prediction) {
  return {static_cast<std::uint32_t>(prediction.samples),
          wire_values::list(prediction.median),
          wire_values::list(prediction.p95),
          wire_values::list(prediction.quality),
          prediction.reliability,
          prediction.idle};
}

Prediction prediction_of(const introspection::LearnedFigures& figures) {
  return {figures.samples,
          wire_values::maybe(figures.median),
          wire_values::maybe(figures.p95),
          wire_values::maybe(figures.quality),
          figures.reliability,
          figures.idle};
}

introspection::CandidateReport report_of(const Candidate& candidate) {
  introspection::CandidateReport report;
  report.csp = candidate.name;
  report.provider = candidate.provider.bytes;
  report.in_process = candidate.in_process;
  report.pid = candidate.pid;
  report.latency = wire_values::list(candidate.latency);
  report.quality = candidate.quality;
  if (candidate.learned) report.learned = {figures_of(*candidate.learned)};
  report.breaker = to_string(candidate.breaker);
  report.quarantine = wire_values::ns(candidate.quarantine);
  report.round = candidate.round;
  return report;
}

Candidate candidate_of(const introspection::CandidateReport& report) {
  Candidate candidate;
  candidate.name = report.csp;
  candidate.provider = {report.provider};
  candidate.in_process = report.in_process;
  candidate.pid = report.pid;
  candidate.latency = wire_values::maybe(report.latency);
  candidate.quality = report.quality;
  if (!report.learned.empty()) candidate.learned = prediction_of(report.learned.front());
  candidate.breaker = named(kBreakers, report.breaker, "breaker state");
  candidate.quarantine = wire_values::duration(report.quarantine);
  candidate.round = report.round;
  return candidate;
}

introspection::AttemptReport report_of(const Attempt& attempt) {
  return {attempt.csp,
          attempt.reason,
          attempt.explores,
          attempt.round,
          wire_values::ns(attempt.remaining),
          wire_values::ns(attempt.slice),
          wire_values::ns(attempt.expected),
          wire_values::ns(attempt.began),
          wire_values::ns(attempt.took),
          to_string(attempt.outcome),
          attempt.check,
          attempt.text,
          wire_values::list(attempt.quality)};
}

Attempt attempt_of(const introspection::AttemptReport& report) {
  using wire_values::duration;
  Attempt attempt;
  static_cast<Choice&>(attempt) = {report.csp,
                                   duration(report.remaining),
                                   duration(report.slice),
                                   duration(report.expected),
                                   report.explores,
                                   report.reason};
  attempt.round = report.round;
  attempt.began = duration(report.began);
  attempt.took = duration(report.took);
  attempt.outcome = named(kOutcomes, report.outcome, "outcome");
  attempt.check = report.check;
  attempt.text = report.text;
  attempt.quality = wire_values::maybe(report.quality);
  return attempt;
}

}  // namespace

const char* to_string(Attempt::Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::Accepted:
      return "accepted";
    case Outcome::Rejected:
      return "rejected";
    case Outcome::Refused:
      return "refused";
    case Outcome::TimedOut:
      return "timed out";
    case Outcome::Disconnected:
      return "disconnected";
    case Outcome::Cancelled:
      return "cancelled";
    case Outcome::Preselected:
      return "preselected";
    case Outcome::Failed:
      break;
  }
  return "failed";
}

introspection::Decision report_of(const DecisionRecord& record) {
  introspection::Decision report;
  report.entity = record.entity;
  report.number = record.number;
  report.time = record.time;
  report.request = record.request;
  report.service = record.interface;
  report.strategy = record.strategy;
  report.execution = record.execution;
  report.features = wire_values::list(record.situation.features);
  report.exploration = record.situation.exploration;
  report.decided = record.situation.past.made;
  report.explored = record.situation.past.explored;
  report.available = wire_values::ns(record.available);
  for (const Candidate& candidate : record.candidates)
    report.candidates.push_back(report_of(candidate));
  for (const Attempt& attempt : record.attempts) report.attempts.push_back(report_of(attempt));
  report.synthesis = record.synthesis;
  report.failure = record.failure;
  report.took = wire_values::ns(record.took);
  report.stuck = static_cast<std::uint32_t>(record.stuck);
  return report;
}

DecisionRecord record_of(const introspection::Decision& report) {
  DecisionRecord record;
  record.entity = report.entity;
  record.number = report.number;
  record.time = report.time;
  record.request = report.request;
  record.interface = report.service;
  record.strategy = report.strategy;
  record.execution = report.execution;
  record.situation.features = wire_values::features(report.features);
  record.situation.exploration = report.exploration;
  record.situation.past = {report.decided, report.explored};
  record.available = record.situation.remaining = wire_values::duration(report.available);
  for (const auto& candidate : report.candidates)
    record.candidates.push_back(candidate_of(candidate));
  for (const auto& attempt : report.attempts) record.attempts.push_back(attempt_of(attempt));
  record.synthesis = report.synthesis;
  record.failure = report.failure;
  record.took = wire_values::duration(report.took);
  record.stuck = report.stuck;
  return record;
}

std::vector<Choice> replay(const DecisionRecord& record, const StrategyFactory& strategies) {
  const auto strategy = strategies.make(record.strategy);
  const auto of_round = [&](std::uint32_t round) {
    std::vector<Candidate> candidates;
    std::copy_if(record.candidates.begin(), record.candidates.end(), std::back_inserter(candidates),
                 [&](const Candidate& candidate) { return candidate.round == round; });
    return candidates;
  };
  std::uint32_t round = 0;
  CandidateIterator iterator(*strategy, of_round(round), record.situation);
  std::vector<Choice> choices;
  for (const Attempt& attempt : record.attempts) {
    if (attempt.round != round) iterator.add(of_round(round = attempt.round));
    if (iterator.done()) {
      throw InvalidArgument("decision " + std::to_string(record.number) +
                            " has more attempts than candidates that may run");
    }
    choices.push_back(iterator.next(attempt.remaining).choice);
  }
  return choices;
}

}  // namespace skein
