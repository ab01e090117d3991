#include "mission/xml/finding.hpp"

#include <algorithm>

#include "core/printable.hpp"

namespace skein::profile {

std::string to_text(const SourcePosition& where) {
  if (where.line == 0) return where.file;
  return where.file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
}

std::string_view to_string(Severity severity) noexcept {
  switch (severity) {
    case Severity::Error:
      return "error";
    case Severity::Warning:
      return "warning";
    case Severity::Note:
      break;
  }
  return "note";
}

std::string to_text(const Finding& finding) {
  std::string text = to_text(finding.where) + ": " + std::string(to_string(finding.severity)) +
                     ": " + finding.problem;
  if (!finding.remedy.empty()) text += "; " + finding.remedy;
  return printable(text, text.size());
}

std::string to_text(const std::vector<Finding>& findings) {
  std::string text;
  for (const auto& finding : findings) text += to_text(finding) + "\n";
  return text;
}

bool has_errors(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::Error; });
}

namespace {

std::string without_last_break(std::string text) {
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace

DescriptionError::DescriptionError(std::vector<Finding> findings)
    : InvalidArgument(without_last_break(to_text(findings))), findings_(std::move(findings)) {}

}  // namespace skein::profile
