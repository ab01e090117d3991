#include "planning_journal.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace skein::navigation {
namespace {

using AE_navigatorI::PlannerCandidate;
using AE_navigatorI::PlanningReport;

constexpr std::size_t kKept = 64;

double in_ms(std::int64_t ns) { return static_cast<double>(ns) / 1e6; }

/// 0 where it is not known.
double in_ms(const std::vector<std::int64_t>& ns) { return ns.empty() ? 0 : in_ms(ns.front()); }

PlannerCandidate candidate_of(const introspection::CandidateReport& candidate) {
  PlannerCandidate planner;
  planner.planner = candidate.csp;
  planner.available = true;
  planner.quarantined = candidate.breaker == introspection::BreakerState::Open;
  planner.declared_ms = in_ms(candidate.latency);
  planner.declared_quality = candidate.quality;
  for (const introspection::LearnedFigures& learned : candidate.learned) {
    planner.runs = learned.similar;
    planner.median_ms = in_ms(learned.median);
    planner.p95_ms = in_ms(learned.p95);
    planner.measured_quality = learned.quality.empty() ? 0 : learned.quality.front();
    planner.accepted = learned.reliability;
  }
  return planner;
}

PlanningReport report_of(const std::string& request_id, const std::vector<Planning>& plannings,
                         const std::string& failure) {
  PlanningReport report;
  report.request_id = request_id;
  for (const auto& [epoch, record] : plannings) {
    report.strategy = record.strategy;
    report.elapsed_ms += in_ms(record.took);
    report.candidates.clear();
    for (const auto& candidate : record.candidates)
      report.candidates.push_back(candidate_of(candidate));
    for (const introspection::Attempt& attempt : record.attempts) {
      report.attempts.push_back({attempt.csp, epoch, attempt.reason, in_words(attempt.outcome),
                                 attempt.check, attempt.text, in_ms(attempt.took)});
    }
  }
  if (report.attempts.empty()) report.failure = failure;
  return report;
}

}  // namespace

void PlanningJournal::begin(const std::string& request_id) {
  const std::lock_guard lock(mutex_);
  at_work_.push_back(request_id);
}

void PlanningJournal::end(const std::string& request_id, const std::vector<Planning>& plannings,
                          const std::string& failure) {
  PlanningReport report = report_of(request_id, plannings, failure);
  const std::lock_guard lock(mutex_);
  for (const PlannerCandidate& candidate : report.candidates) known_[candidate.planner] = candidate;
  add_absent(report);
  at_work_.erase(std::find(at_work_.begin(), at_work_.end(), request_id));
  std::erase_if(reports_, [&](const PlanningReport& old) { return old.request_id == request_id; });
  reports_.push_back(std::move(report));
  if (reports_.size() > kKept) reports_.pop_front();
}

std::string PlanningJournal::current() const {
  const std::lock_guard lock(mutex_);
  return at_work_.empty() ? std::string() : at_work_.back();
}

std::size_t PlanningJournal::at_work() const {
  const std::lock_guard lock(mutex_);
  return at_work_.size();
}

PlanningReport PlanningJournal::report(const std::string& request_id) const {
  const std::lock_guard lock(mutex_);
  for (const PlanningReport& report : reports_) {
    if (report.request_id == request_id) return report;
  }
  throw AE_navigatorI::UnknownRequest(fmt::format(
      "no request '{}' among the last {} that were decided", request_id, reports_.size()));
}

void PlanningJournal::add_absent(PlanningReport& report) const {
  for (const auto& [name, candidate] : known_) {
    const bool present =
        std::any_of(report.candidates.begin(), report.candidates.end(),
                    [&name = name](const PlannerCandidate& c) { return c.planner == name; });
    if (present) continue;
    report.candidates.push_back(candidate);
    report.candidates.back().available = false;
  }
}

}  // namespace skein::navigation
