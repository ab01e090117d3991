#include <algorithm>

#include "core/printable.hpp"
#include "selection_text.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"
#include "wire_values.hpp"

namespace skein {
namespace {

using selection_text::number;
using selection_text::percent;

std::string in_ms(std::int64_t ns) { return selection_text::in_ms(wire_values::duration(ns)); }

/// Records come from the network and from files, too.
std::string shown(const std::string& text) {
  constexpr std::size_t kLongest = 4096;
  return printable(text, kLongest);
}

std::string learned_text(const introspection::LearnedFigures& learned) {
  std::string text = learned.similar == 0 ? "over requests of which none was similar:"
                     : learned.similar == 1
                         ? "over 1 similar request:"
                         : "over " + std::to_string(learned.similar) + " similar requests:";
  if (!learned.median.empty()) text += " median " + in_ms(learned.median[0]) + ",";
  if (!learned.p95.empty()) text += " p95 " + in_ms(learned.p95[0]) + ",";
  if (!learned.quality.empty()) text += " quality " + number(learned.quality[0]) + ",";
  return text + " reliability " + percent(learned.reliability);
}

std::string line_of(const std::vector<introspection::NamedValue>& features) {
  std::string text;
  for (const auto& feature : features)
    text += (text.empty() ? "  for " : ", ") + shown(feature.name) + " " + number(feature.value);
  return text.empty() ? text : text + "\n";
}

std::string line_of(const introspection::CandidateReport& candidate, bool histories_were_read) {
  std::string text = "  " + shown(candidate.csp);
  text +=
      candidate.in_process ? " (in the process)" : " (pid " + std::to_string(candidate.pid) + ")";
  text += candidate.latency.empty() ? " declares no latency"
                                    : " declares " + in_ms(candidate.latency[0]);
  text += candidate.quality == 0 ? ", no quality" : ", quality " + number(candidate.quality);
  if (!candidate.learned.empty()) {
    text += "; " + learned_text(candidate.learned[0]);
  } else if (histories_were_read) {
    text += "; has not run before";
  }
  if (candidate.breaker == introspection::BreakerState::Open) {
    text += "; in quarantine for " + in_ms(candidate.quarantine) + " more";
  } else if (candidate.breaker == introspection::BreakerState::HalfOpen) {
    text += "; may be probed after quarantine";
  }
  return text + "\n";
}

std::string line_of(const introspection::Attempt& attempt) {
  std::string text = "  at " + in_ms(attempt.began) + " " + shown(attempt.csp) + ", for " +
                     in_ms(attempt.slice) + ": " + shown(attempt.reason) + "\n    " +
                     in_words(attempt.outcome) + " after " + in_ms(attempt.took);
  if (!attempt.check.empty()) text += " by the check '" + shown(attempt.check) + "'";
  if (!attempt.quality.empty()) text += ", quality " + number(attempt.quality[0]);
  if (!attempt.text.empty()) text += ": " + shown(attempt.text);
  return text + "\n";
}

}  // namespace

std::string explain(const introspection::Decision& record) {
  const bool preselected = record.execution == "none";
  std::string text = "decision " + std::to_string(record.number) + " of " + shown(record.entity);
  if (!record.request.empty()) text += " on '" + shown(record.request) + "'";
  text += ": " + shown(record.service) + " within " + in_ms(record.available) + ", strategy " +
          shown(record.strategy) +
          (preselected ? ", for the Body to call itself\n"
                       : ", " + shown(record.execution) + " at a time\n");
  text += line_of(record.features);
  const bool histories_were_read =
      std::any_of(record.candidates.begin(), record.candidates.end(),
                  [](const auto& candidate) { return !candidate.learned.empty(); });
  for (const auto& candidate : record.candidates) text += line_of(candidate, histories_were_read);
  for (const auto& attempt : record.attempts) text += line_of(attempt);
  if (record.stuck > 0)
    text += "  " + std::to_string(record.stuck) + " CSPs in the process do not return\n";
  text += !record.failure.empty() ? "  failed" : preselected ? "  selected" : "  answered";
  text += " after " + in_ms(record.took);
  if (!record.synthesis.empty()) text += ": " + shown(record.synthesis);
  if (!record.failure.empty()) text += ": " + shown(record.failure);
  return text + "\n";
}

}  // namespace skein
