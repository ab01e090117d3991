#include "planning_journal.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace skein::navigation {
namespace {

using AE_navigatorI::PlannerCandidate;
using AE_navigatorI::PlanningReport;

constexpr std::size_t kKept = 64;

double in_ms(Duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

PlannerCandidate candidate_of(const Candidate& candidate) {
  return {candidate.name, in_ms(candidate.latency.value_or(Duration::zero())), candidate.quality,
          true};
}

/// Why it was chosen and what came of it, in one line.
std::string line_of(const Attempt& attempt) {
  std::string line = fmt::format("{}; {} after {:.0f} ms", attempt.reason,
                                 to_string(attempt.outcome), in_ms(attempt.took));
  if (!attempt.text.empty()) line += ": " + attempt.text;
  return line;
}

PlanningReport report_of(const std::string& request_id, const DecisionRecord& record,
                         const std::string& failure) {
  PlanningReport report;
  report.request_id = request_id;
  report.elapsed_ms = in_ms(record.took);
  for (const Candidate& candidate : record.candidates) {
    report.candidates.push_back(candidate_of(candidate));
  }
  for (const Attempt& attempt : record.attempts) {
    report.tried.push_back(attempt.csp);
    report.reason += (report.reason.empty() ? "" : "\n") + line_of(attempt);
  }
  if (record.attempts.empty()) report.reason = failure;
  return report;
}

}  // namespace

void PlanningJournal::begin(const std::string& request_id) {
  const std::lock_guard lock(mutex_);
  at_work_.push_back(request_id);
}

void PlanningJournal::end(const std::string& request_id, const DecisionRecord& record,
                          const std::string& failure) {
  PlanningReport report = report_of(request_id, record, failure);
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
    const bool present = std::any_of(report.candidates.begin(), report.candidates.end(),
                                     [&](const PlannerCandidate& c) { return c.planner == name; });
    if (present) continue;
    report.candidates.push_back(candidate);
    report.candidates.back().available = false;
  }
}

}  // namespace skein::navigation
