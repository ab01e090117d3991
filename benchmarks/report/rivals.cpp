#include "report/rivals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/plot.hpp"

namespace skein::benchmarks {
namespace {

/// Values in the order in which they were first asked for.
template <class Value>
class Ordered {
 public:
  Value& operator[](const std::string& name) {
    for (auto& [known, value] : entries_) {
      if (known == name) return value;
    }
    return entries_.emplace_back(name, Value{}).second;
  }
  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }

 private:
  std::vector<std::pair<std::string, Value>> entries_;
};

struct Cell {
  Summary summary;
  Absence absence;
};

struct Matrix {
  std::vector<std::string> variants;
  Ordered<std::map<std::string, Cell>> contenders;
};

std::string placement_of(const Comparison& comparison) {
  return comparison.parameters.at("placement").get<std::string>();
}

Ordered<Matrix> matrices_of(const Comparisons& comparisons) {
  Ordered<Matrix> matrices;
  for (const Comparison* comparison : comparisons) {
    Matrix& matrix = matrices[placement_of(*comparison)];
    const std::string variant = variant_of(*comparison);
    if (std::ranges::find(matrix.variants, variant) == matrix.variants.end()) {
      matrix.variants.push_back(variant);
    }
    // Of a pair with an absence it is the rival that was not measured, unless the subject never
    // was.
    const auto put = [&](const std::string& name, const Summary& summary, const Absence& absence) {
      Cell& cell = matrix.contenders[name][variant];
      if (cell.summary.samples == 0) cell = {summary, absence};
    };
    put(comparison->subject, comparison->summary(), comparison->absence);
    put(comparison->rival, comparison->rival_summary(), comparison->absence);
  }
  return matrices;
}

double best_of(const Matrix& matrix, const std::string& variant, bool skein) {
  double best = 1e18;
  for (const auto& [name, cells] : matrix.contenders) {
    const auto found = cells.find(variant);
    const bool measured = found != cells.end() && found->second.summary.samples > 0;
    if (measured && name.starts_with("skein") == skein)
      best = std::min(best, found->second.summary.p50);
  }
  return best;
}

std::string cell_text(const Matrix& matrix, const std::string& name, const std::string& variant,
                      const Cell& cell) {
  if (cell.summary.samples == 0) {
    return fmt::format("<td class='{}' title='{}'>not measured</td>", class_of(cell.absence),
                       escaped(cell.absence.reason));
  }
  const bool skein = name.starts_with("skein");
  const double other = best_of(matrix, variant, !skein);
  const char* look = !skein || other > 1e17 ? "" : cell.summary.p50 <= other ? "good" : "bad";
  return fmt::format("<td class='{}'>{} <small>({})</small></td>", look,
                     time_text(cell.summary.p50), time_text(cell.summary.p99));
}

std::string table_of_matrix(const std::string& placement, const Matrix& matrix) {
  std::string html = fmt::format("<h3>{}</h3><table><thead><tr><th></th>", escaped(placement));
  for (const std::string& variant : matrix.variants) html += "<th>" + escaped(variant) + "</th>";
  html += "</tr></thead><tbody>";
  for (const auto& [name, cells] : matrix.contenders) {
    html += "<tr><td>" + escaped(name) + "</td>";
    for (const std::string& variant : matrix.variants) {
      const auto found = cells.find(variant);
      html += found == cells.end() ? "<td></td>" : cell_text(matrix, name, variant, found->second);
    }
    html += "</tr>";
  }
  return html + "</tbody></table>";
}

struct Verdict {
  std::vector<std::string> behind;
  std::vector<std::string> ahead;
};

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::string variant_of(const Comparison& comparison) {
  std::string text;
  for (const auto& [name, value] : comparison.parameters.items()) {
    if (name == "placement") continue;
    std::string words = name;
    std::ranges::replace(words, '_', ' ');
    text += (text.empty() ? "" : ", ") + (name == "size_bytes" ? size_text(value.get<std::size_t>())
                                                               : value.dump() + " " + words);
  }
  return text;
}

bool is_of_matrix(const Comparison& comparison) {
  return comparison.parameters.contains("placement") && !comparison.rival.starts_with("raw") &&
         !comparison.subject.starts_with("raw") && comparison.claim != "a call over DDS";
}

std::string rivals_verdict(const std::vector<Comparison>& comparisons) {
  Ordered<Verdict> verdicts;
  for (const Comparison& comparison : comparisons) {
    if (!is_of_matrix(comparison) || !comparison.goal_p50 || comparison.absence) continue;
    const double ratio = comparison.ratio_p50();
    Verdict& verdict =
        verdicts[fmt::format("{}, {}, {}: {}", comparison.claim, variant_of(comparison),
                             placement_of(comparison), comparison.subject)];
    (ratio > *comparison.goal_p50 ? verdict.behind : verdict.ahead)
        .push_back(fmt::format("{} ({:.2f}×)", comparison.rival, ratio));
  }
  std::string losing, winning;
  for (const auto& [what, verdict] : verdicts) {
    const std::string ahead = verdict.ahead.empty() ? "" : "ahead of " + joined(verdict.ahead);
    if (verdict.behind.empty()) {
      winning += fmt::format("<li>{} is {}</li>", escaped(what), escaped(ahead));
    } else {
      losing +=
          fmt::format("<li>{} is <b>behind {}</b>{}</li>", escaped(what),
                      escaped(joined(verdict.behind)), escaped(ahead.empty() ? "" : "; " + ahead));
    }
  }
  if (losing.empty() && winning.empty()) return "";
  const auto list = [](const char* title, const std::string& items) {
    return fmt::format("<details open><summary>{}</summary><ul>{}</ul></details>", title,
                       items.empty() ? "<li>Nowhere.</li>" : items);
  };
  return "<h3>Beside others (Skein's median by theirs, or by the goal's)</h3>" +
         list("Skein loses", losing) + list("Skein wins", winning);
}

std::string section_of_rivals(const std::string& claim, const Comparisons& comparisons) {
  std::string html = fmt::format(
      "<section><h2>{}</h2><p class='note'>Median, and in brackets the 99th "
      "percentile. Red: some other contender's median is shorter.</p>",
      escaped(claim));
  for (const auto& [placement, matrix] : matrices_of(comparisons))
    html += table_of_matrix(placement, matrix);
  return html + "</section>";
}

}  // namespace skein::benchmarks
