#include "report/report.hpp"

#include <fmt/format.h>

#include <fstream>
#include <utility>

#include "report/goals.hpp"
#include "report/plot.hpp"
#include "report/rivals.hpp"
#include "report/sections.hpp"
#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

constexpr const char* kStyle = R"(
body{font:15px/1.5 system-ui,sans-serif;color:#1d2430;background:#fff;max-width:1540px;margin:2em auto;padding:0 1em}
h1{font-size:1.6em;margin-bottom:0}h2{margin-top:1.8em;border-bottom:1px solid #dde2ea;padding-bottom:.2em}
h3{font-size:1em;margin:.9em 0 .2em}ul{margin:.2em 0}
svg text{font:11px system-ui,sans-serif;fill:#44506a}svg .title{font-size:13px;font-weight:600;fill:#1d2430}
svg .value{font-size:9.5px}svg .grid{stroke:#e6eaf0}svg .mark{stroke:#c0392b;stroke-dasharray:4 3}
svg .median{stroke:#1d2430;stroke-width:2}svg .dot{fill:#fff;stroke:#1d2430}
.panels{display:flex;flex-wrap:wrap;gap:6px}.key b{margin-right:1em}.skein{color:#0b6bcb}.raw{color:#d08700}.floor{color:#999}
table{border-collapse:collapse;font-size:12.5px;margin-top:.5em}td,th{padding:2px 8px;text-align:right;white-space:nowrap}
td:nth-child(-n+3),th:nth-child(-n+3){text-align:left}tbody tr:nth-child(odd){background:#f6f8fb}
.rival{color:#6a7590}.good{color:#0a8f5b}.bad{color:#c0392b;font-weight:600}.skipped{color:#b36b00;text-align:left}
.facts td{text-align:left}.note{color:#44506a}summary{cursor:pointer;color:#44506a}
)";

constexpr const char* kMethod = R"(
<p class='note'>Every contender is a provider and a client in processes of their own, both on this machine. All of
them are alive during the whole run and take short turns in a new random order each round; nothing is compared
across runs. <b>Raw</b> is the vendor's own API with the same transport settings and the same threading contract
(nothing of the user's runs on the vendor's threads but a notification; the server answers from a thread of its own),
and encodes with Fast CDR. A mixed pair is compared with the slower vendor's raw call, and for information with a raw
mixed pair. The service is the same function everywhere: it returns a copy of what it gets. Times are round trips as
the caller sees them; the content travels both ways. Both processes of a contender stand on the same cores as
their rivals', either sharing one or on one each: where the scheduler may choose, its whim rules at small sizes.</p>
)";

/// What has a plot for each placement is a section for each.
std::string title_of(const Comparison& comparison) {
  const bool one_placement =
      comparison.parameters.contains("placement") && !is_of_matrix(comparison);
  return comparison.claim +
         (one_placement ? ", " + comparison.parameters.at("placement").get<std::string>() : "");
}

/// Claims in the order in which they first appear.
std::vector<std::pair<std::string, Comparisons>> by_claim(
    const std::vector<Comparison>& comparisons) {
  std::vector<std::pair<std::string, Comparisons>> claims;
  for (const Comparison& comparison : comparisons) {
    const std::string claim = title_of(comparison);
    auto found = claims.begin();
    while (found != claims.end() && found->first != claim) ++found;
    if (found == claims.end()) found = claims.insert(claims.end(), {claim, {}});
    found->second.push_back(&comparison);
  }
  return claims;
}

std::string section_of(const std::string& claim, const Comparisons& members) {
  if (is_of_matrix(*members.front())) return section_of_rivals(claim, members);
  if (members.front()->unit != "us") return section_of_figures(claim, members);
  const bool by_size = members.front()->parameters.contains("size_bytes");
  return by_size ? section_by_size(claim, members) : section_of_times(claim, members);
}

std::string machine_section(const RunFacts& run) {
  std::string rows;
  for (const auto& [name, value] : run.machine) {
    rows += fmt::format("<tr><td>{}</td><td>{}</td></tr>", escaped(name), escaped(value));
  }
  return "<section><h2>The machine</h2><table class='facts'>" + rows + "</table></section>";
}

}  // namespace

void write_report(const std::vector<Comparison>& comparisons, const RunFacts& run,
                  const std::string& path) {
  std::string page = fmt::format(
      "<!doctype html><html lang='en'><head><meta charset='utf-8'><title>Skein: benchmarks</title>"
      "<style>{}</style></head><body><h1>Skein: benchmarks</h1>{}",
      kStyle, kMethod);
  for (const std::string& remark : run.remarks) {
    if (!remark.empty()) page += "<p class='bad'>" + escaped(remark) + "</p>";
  }
  page += goals_section(comparisons);
  page += verdict_section(comparisons);
  for (const auto& [claim, members] : by_claim(comparisons)) {
    page += section_of(claim, members);
  }
  page += machine_section(run) + "</body></html>\n";
  std::ofstream file(path);
  file << page;
  if (!file.flush()) throw Internal(path + " cannot be written; is its folder there and writable?");
}

}  // namespace skein::benchmarks
