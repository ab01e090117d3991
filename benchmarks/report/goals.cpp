#include "report/goals.hpp"

#include <fmt/format.h>

#include <fstream>

#include "harness/goals.hpp"
#include "report/plot.hpp"
#include "report/sections.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

std::string limit_text(const Goal& goal) {
  const std::string p99 = goal.p99 ? fmt::format(", p99 ≤ {:.2f}×", *goal.p99) : "";
  return fmt::format("p50 ≤ {:.2f}×{}", goal.p50, p99);
}

std::string worst_text(const Goal& goal, const Comparison& worst) {
  const std::string place = place_of(worst);
  const std::string p99 = goal.p99 ? fmt::format(", p99 {:.2f}×", worst.ratio_p99()) : "";
  return fmt::format("<td>p50 {:.2f}×{}</td><td>{} against {}</td><td>{} beside {}{}{}</td>",
                     worst.ratio_p50(), p99, figure_text(worst.summary().p50, worst.unit),
                     figure_text(worst.rival_summary().p50, worst.unit), escaped(worst.subject),
                     escaped(worst.rival), place.empty() ? "" : "; ", escaped(place));
}

const char* unmeasured(const Verdict& verdict) {
  return verdict.failed > 0 ? "missed: failed" : "not measured";
}

std::string judgement_of(const Verdict& verdict) {
  const bool aim = verdict.goal->kind == Goal::Kind::Aim;
  const char* word = is_met(verdict) ? "met" : aim ? "not yet" : "missed";
  const std::string failed = verdict.failed > 0 ? fmt::format(", {} failed", verdict.failed) : "";
  return fmt::format("{} ({} of {}{})", word, verdict.met, verdict.measured, failed);
}

std::string verdict_row(const Verdict& verdict) {
  const std::string row = fmt::format("<tr><td>{}</td><td>{}</td>", escaped(verdict.goal->text),
                                      limit_text(*verdict.goal));
  if (verdict.worst == nullptr) {
    return row + fmt::format("<td colspan='4' class='{}'>{}</td></tr>",
                             verdict.failed > 0 ? "bad" : "skipped", unmeasured(verdict));
  }
  const char* look = is_met(verdict)                         ? "good"
                     : verdict.goal->kind == Goal::Kind::Aim ? "skipped"
                                                             : "bad";
  return row + worst_text(*verdict.goal, *verdict.worst) +
         fmt::format("<td class='{}'>{}</td></tr>", look, judgement_of(verdict));
}

std::string markdown_row_of(const Verdict& verdict) {
  const Goal& goal = *verdict.goal;
  if (verdict.worst == nullptr) {
    return fmt::format("| {} | {} | | {} |\n", goal.text, limit_text(goal), unmeasured(verdict));
  }
  const std::string p99 = goal.p99 ? fmt::format(", p99 {:.2f}×", verdict.worst->ratio_p99()) : "";
  return fmt::format("| {} | {} | p50 {:.2f}×{} | {} |\n", goal.text, limit_text(goal),
                     verdict.worst->ratio_p50(), p99, judgement_of(verdict));
}

}  // namespace

std::string goals_section(const std::vector<Comparison>& comparisons) {
  std::string rows;
  for (const Verdict& verdict : judge(comparisons)) rows += verdict_row(verdict);
  return "<section><h2>Goals</h2><table><thead><tr><th>goal</th><th>limit</th><th>worst in this "
         "run</th><th>medians</th><th>where</th><th>comparisons that meet "
         "it</th></tr></thead><tbody>" +
         rows + "</tbody></table></section>";
}

std::string goals_table(const std::vector<Comparison>& comparisons) {
  std::string table = "| goal | limit | worst | comparisons that meet it |\n|---|---|---|---|\n";
  for (const Verdict& verdict : judge(comparisons)) table += markdown_row_of(verdict);
  return table;
}

void write_goals(const std::vector<Comparison>& comparisons, const std::string& path) {
  std::ofstream file(path);
  file << goals_table(comparisons);
  if (!file.flush()) throw Internal(path + " cannot be written; is its folder there and writable?");
}

}  // namespace skein::benchmarks
