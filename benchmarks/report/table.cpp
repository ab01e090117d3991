#include <fmt/format.h>

#include "harness/goals.hpp"
#include "report/plot.hpp"
#include "report/sections.hpp"

namespace skein::benchmarks {
namespace {

std::string goal_text(const Comparison& comparison) {
  return meets_goal(comparison) ? "<td class='good'>met</td>" : "<td class='bad'>missed</td>";
}

std::string row_of(const Comparison& comparison) {
  std::string row =
      fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>", escaped(comparison.subject),
                  escaped(comparison.rival), place_of(comparison));
  if (const Absence& absence = comparison.absence) {
    return row + fmt::format("<td colspan='12' class='{}'>{}: {}</td></tr>", class_of(absence),
                             absence.failed ? "failed" : "skipped", escaped(absence.reason));
  }
  const Summary own = comparison.summary(), rival = comparison.rival_summary();
  row += fmt::format("<td>{}</td>", own.samples);
  for (const double time : {own.p50, own.p90, own.p95, own.p99, own.p999}) {
    row += "<td>" + figure_text(time, comparison.unit) + "</td>";
  }
  for (const double time : {rival.p50, rival.p95, rival.p99})
    row += "<td class='rival'>" + figure_text(time, comparison.unit) + "</td>";
  row += fmt::format("<td><b>{:.2f}</b></td><td>{:.2f}</td>", comparison.ratio_p50(),
                     comparison.ratio_p99());
  return row + (comparison.goal_p50 ? goal_text(comparison) : "<td></td>") + "</tr>";
}

}  // namespace

std::string table_of(const Comparisons& comparisons) {
  std::string rows;
  for (const Comparison* comparison : comparisons) rows += row_of(*comparison);
  return "<details open><summary>All "
         "figures</summary><table><thead><tr><th>subject</th><th>rival</th><th></th>"
         "<th>samples</th><th>p50</th><th>p90</th><th>p95</th><th>p99</th><th>p99.9</th><th>rival "
         "p50</th>"
         "<th>rival p95</th><th>rival p99</th><th>ratio p50</th><th>ratio "
         "p99</th><th>goal</th></tr></thead>"
         "<tbody>" +
         rows + "</tbody></table></details>";
}

}  // namespace skein::benchmarks
