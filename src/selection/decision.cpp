#include <tuple>

#include "decision_record.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"
#include "wire_values.hpp"

namespace skein {

using introspection::Attempt;
using introspection::BreakerState;
using introspection::CandidateReport;
using introspection::Decision;
using introspection::Outcome;

namespace {

introspection::LearnedFigures figures_of(const Prediction& prediction) {
  std::vector<introspection::SimilarRun> runs;
  runs.reserve(prediction.runs.size());
  for (const SimilarRun& run : prediction.runs) {
    runs.push_back({run.request, run.weight, wire_values::ns(run.took), run.accepted, run.late,
                    wire_values::list(run.quality)});
  }
  return {std::move(runs),
          static_cast<std::uint32_t>(prediction.similar),
          wire_values::list(prediction.median),
          wire_values::list(prediction.p95),
          wire_values::list(prediction.quality),
          prediction.reliability,
          prediction.idle};
}

Prediction prediction_of(const introspection::LearnedFigures& figures) {
  std::vector<SimilarRun> runs;
  for (const auto& run : figures.runs) {
    runs.push_back({run.request, run.weight, wire_values::duration(run.took), run.accepted,
                    run.late, wire_values::maybe(run.quality)});
  }
  return {std::move(runs),
          figures.similar,
          wire_values::maybe(figures.median),
          wire_values::maybe(figures.p95),
          wire_values::maybe(figures.quality),
          figures.reliability,
          figures.idle};
}

template <class To, class From>
To breaker(From state) {
  switch (state) {
    case From::Closed:
      return To::Closed;
    case From::Open:
      return To::Open;
    case From::HalfOpen:
      break;
  }
  return To::HalfOpen;
}

Utility::Aim aim_of(const std::string& name) {
  for (const auto aim : {Utility::Aim::AnyByDeadline, Utility::Aim::GoodEnoughSoon}) {
    if (name == to_string(aim)) return aim;
  }
  return Utility::Aim::BestByDeadline;
}

CandidateReport report_of(const Candidate& candidate) {
  CandidateReport report;
  report.csp = candidate.name;
  report.provider = candidate.provider.bytes;
  report.in_process = candidate.in_process;
  report.pid = candidate.pid;
  report.latency = wire_values::list(candidate.latency);
  report.quality = candidate.quality;
  if (candidate.learned) report.learned = {figures_of(*candidate.learned)};
  report.breaker = breaker<BreakerState>(candidate.breaker);
  report.quarantine = wire_values::ns(candidate.quarantine);
  report.round = candidate.round;
  return report;
}

}  // namespace

void decision_record::list(Decision& record, const std::vector<Candidate>& candidates) {
  for (const Candidate& candidate : candidates) record.candidates.push_back(report_of(candidate));
}

Candidate decision_record::candidate_of(const CandidateReport& report) {
  Candidate candidate;
  candidate.name = report.csp;
  candidate.provider = {report.provider};
  candidate.in_process = report.in_process;
  candidate.pid = report.pid;
  candidate.latency = wire_values::maybe(report.latency);
  candidate.quality = report.quality;
  if (!report.learned.empty()) candidate.learned = prediction_of(report.learned.front());
  candidate.breaker = breaker<CircuitBreaker::State>(report.breaker);
  candidate.quarantine = wire_values::duration(report.quarantine);
  candidate.round = report.round;
  return candidate;
}

Situation decision_record::situation_of(const Decision& record) {
  return {wire_values::features(record.features),
          wire_values::duration(record.available),
          record.exploration,
          {record.decided, record.explored},
          {aim_of(record.utility), record.good_enough},
          {}};
}

void decision_record::note_choice(Attempt& attempt, const CandidateIterator::Next& next,
                                  Duration remaining) {
  attempt.csp = next.candidate.name;
  attempt.reason = next.selection.reason;
  attempt.explores = next.selection.explores;
  attempt.remaining = wire_values::ns(remaining);
  attempt.slice = wire_values::ns(next.selection.slice);
  attempt.expected = wire_values::ns(next.selection.expected);
}

const char* in_words(Outcome outcome) noexcept {
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

bool same_choice(const Attempt& one, const Attempt& other) {
  const auto choice = [](const Attempt& attempt) {
    return std::tie(attempt.csp, attempt.reason, attempt.explores, attempt.remaining, attempt.slice,
                    attempt.expected, attempt.round);
  };
  return choice(one) == choice(other);
}

std::vector<Attempt> replay(const Decision& record, const StrategyFactory& strategies) {
  const auto strategy = strategies.make(record.strategy);
  const auto of_round = [&](std::uint32_t round) {
    std::vector<Candidate> candidates;
    for (const CandidateReport& report : record.candidates) {
      if (report.round == round) candidates.push_back(decision_record::candidate_of(report));
    }
    return candidates;
  };
  std::uint32_t round = 0;
  CandidateIterator iterator(*strategy, of_round(round), decision_record::situation_of(record));
  std::vector<Attempt> attempts = record.attempts;
  for (Attempt& attempt : attempts) {
    if (attempt.round != round) iterator.add(of_round(round = attempt.round));
    if (iterator.done()) {
      throw InvalidArgument("decision " + std::to_string(record.number) +
                            " has more attempts than candidates that may run");
    }
    const Duration remaining = wire_values::duration(attempt.remaining);
    decision_record::note_choice(attempt, iterator.next(remaining), remaining);
  }
  return attempts;
}

}  // namespace skein
