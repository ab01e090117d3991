#include "report.hpp"

#include <algorithm>

#include "command/print/json_output.hpp"
#include "command/print/wrapped.hpp"
#include "core/printable.hpp"

namespace skein::command::doctor {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kLongest = 4096;

std::string column(std::string text, std::size_t width) {
  text.resize(std::max(text.size() + 1, width), ' ');
  return text;
}

std::string line(const std::string& head, const std::string& text, std::size_t indent) {
  if (text.empty()) return {};
  return column(head, indent) + wrapped(printable(text, kLongest), kWidth, indent) + "\n";
}

std::string symptom_text(const Symptom& symptom) {
  constexpr std::size_t kSeverity = 9, kText = 24, kDetail = 20;
  const std::string head = column(to_string(symptom.severity), kSeverity) + symptom.about;
  return line(head, symptom.cause, kText) + line("         evidence", symptom.evidence, kDetail) +
         line("         remedy", symptom.remedy, kDetail);
}

std::string count(const Symptoms& symptoms, Severity severity, const std::string& what) {
  const auto number = std::ranges::count(symptoms, severity, &Symptom::severity);
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

}  // namespace

std::string to_text(const Symptoms& symptoms) {
  std::string text;
  for (const Symptom& symptom : symptoms) text += symptom_text(symptom);
  return text + count(symptoms, Severity::Error, "error") + ", " +
         count(symptoms, Severity::Warning, "warning") + "\n";
}

void print_as_json(const Symptoms& symptoms) {
  auto findings = nlohmann::ordered_json::array();
  for (const Symptom& symptom : symptoms) {
    findings.push_back({{"severity", to_string(symptom.severity)},
                        {"about", symptom.about},
                        {"cause", symptom.cause},
                        {"evidence", symptom.evidence},
                        {"remedy", symptom.remedy}});
  }
  print_json({{"worst", to_string(worst_of(symptoms))}, {"findings", findings}}, true);
}

}  // namespace skein::command::doctor
