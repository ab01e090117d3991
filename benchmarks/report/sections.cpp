#include "report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "harness/goals.hpp"
#include "report/plot.hpp"
#include "report/rivals.hpp"

namespace skein::benchmarks {
namespace {

constexpr std::array<double, 7> kTail{0.5, 0.75, 0.9, 0.95, 0.99, 0.995, 0.999};

bool measured(const Comparison& comparison) { return !comparison.absence; }
bool has_goal(const Comparison& comparison) { return comparison.goal_p50.has_value(); }

bool is_beside_raw(const Comparison& comparison) {
  return comparison.subject.starts_with("skein") && comparison.rival.starts_with("raw");
}

std::size_t size_of(const Comparison& comparison) {
  return comparison.parameters.at("size_bytes").get<std::size_t>();
}

const char* colour_of(const std::string& name) {
  static const std::map<std::string, const char*> kColours{{"fastdds", "#0b6bcb"},
                                                           {"cyclonedds", "#0a8f5b"},
                                                           {"fastdds-cyclonedds", "#c4581a"},
                                                           {"cyclonedds-fastdds", "#8a3ab9"}};
  const auto found = kColours.find(name.substr(name.find(' ') + 1));
  return found == kColours.end() ? "#777777" : found->second;
}

std::vector<std::string> subjects_with_goal(const Comparisons& comparisons) {
  std::vector<std::string> names;
  for (const Comparison* comparison : comparisons) {
    if (!has_goal(*comparison)) continue;
    if (std::find(names.begin(), names.end(), comparison->subject) == names.end()) {
      names.push_back(comparison->subject);
    }
  }
  return names;
}

/// Every contender's samples by size, whether it stands as a subject or as a rival.
std::map<std::string, std::map<std::size_t, Summary>> contenders(const Comparisons& comparisons) {
  std::map<std::string, std::map<std::size_t, Summary>> all;
  for (const Comparison* comparison : comparisons) {
    if (!measured(*comparison)) continue;
    all[comparison->subject][size_of(*comparison)] = comparison->summary();
    all[comparison->rival][size_of(*comparison)] = comparison->rival_summary();
  }
  return all;
}

Axis size_axis(const std::set<std::size_t>& sizes) {
  Axis axis{"content, each way", *sizes.begin() * 0.7, *sizes.rbegin() * 1.5, true};
  for (const std::size_t size : sizes) axis.ticks.emplace_back(size, size_text(size));
  return axis;
}

std::string latency_panels(const Comparisons& comparisons) {
  const auto all = contenders(comparisons);
  std::set<std::size_t> sizes;
  double low = 1e12, high = 0;
  for (const auto& [name, by_size] : all) {
    for (const auto& [size, summary] : by_size) {
      sizes.insert(size);
      low = std::min(low, summary.p50);
      high = std::max(high, summary.p50);
    }
  }
  if (sizes.empty()) return "";
  const auto line_of = [&](const std::string& name, const std::string& colour, bool dashed) {
    Line line{name, colour, dashed};
    if (!all.contains(name)) return line;
    for (const auto& [size, summary] : all.at(name)) line.points.emplace_back(size, summary.p50);
    return line;
  };
  std::string html = "<div class='panels'>";
  for (const std::string& subject : subjects_with_goal(comparisons)) {
    const std::string pair = subject.substr(subject.find(' ') + 1);
    html += line_plot(
        pair + ": median", size_axis(sizes), Axis::times("", low, high),
        {line_of("unix socket", "#999999", false), line_of("raw " + pair, "#d08700", true),
         line_of(subject, colour_of(subject), false)});
  }
  return html +
         "</div><p class='key'><b class='skein'>━ Skein</b> <b class='raw'>╍ raw</b> "
         "<b class='floor'>━ Unix socket</b></p>";
}

std::string ratio_bars(const Comparisons& comparisons) {
  std::map<std::size_t, BarGroup> groups;
  std::string key;
  for (const Comparison* comparison : comparisons) {
    if (!has_goal(*comparison) || !measured(*comparison)) continue;
    BarGroup& group = groups[size_of(*comparison)];
    group.label = size_text(size_of(*comparison));
    group.bars.push_back(
        {colour_of(comparison->subject), comparison->ratio_p50(), comparison->ratio_p99()});
  }
  for (const std::string& subject : subjects_with_goal(comparisons)) {
    key += fmt::format("<b style='color:{}'>■ {}</b> ", colour_of(subject), escaped(subject));
  }
  std::vector<BarGroup> bars;
  for (auto& [size, group] : groups) bars.push_back(std::move(group));
  return bar_plot("Skein / raw (less is better; mixed pairs against the slower vendor)",
                  "ratio of times", bars, {{1.0, "1 = raw"}, {1.05, ""}}) +
         "<p class='key'>" + key + "bar: p50 (goal: 1.05), dot: p99 (goal: 1.15; cut off at 4)</p>";
}

std::string tail_panels(const Comparisons& comparisons) {
  std::map<std::size_t, std::vector<Line>> panels;
  double low = 1e12, high = 0;
  for (const Comparison* comparison : comparisons) {
    if (!has_goal(*comparison) || !measured(*comparison)) continue;
    const auto add = [&](const std::string& name, std::vector<double> samples, bool dashed) {
      std::sort(samples.begin(), samples.end());
      Line line{name, colour_of(name), dashed};
      for (const double q : kTail) {
        const double time = quantile(samples, q);
        line.points.emplace_back(1 / (1 - q), time);
        low = std::min(low, time);
        high = std::max(high, time);
      }
      panels[size_of(*comparison)].push_back(std::move(line));
    };
    const std::string pair = comparison->subject.substr(comparison->subject.find(' ') + 1);
    add(comparison->subject, comparison->samples, false);
    if (pair.find('-') == std::string::npos)
      add(comparison->rival, comparison->rival_samples, true);
  }
  std::string html = "<div class='panels'>";
  for (const auto& [size, lines] : panels) {
    double panel_low = 1e12, panel_high = 0;
    for (const Line& line : lines) {
      panel_low = std::min(panel_low, line.points.front().second);
      panel_high = std::max(panel_high, line.points.back().second);
    }
    Axis x{"share of calls that are faster",
           1.9,
           1100,
           true,
           {{2, "50 %"}, {10, "90 %"}, {100, "99 %"}, {1000, "99.9 %"}}};
    html +=
        line_plot(size_text(size) + ": the tail", x, Axis::times("", panel_low, panel_high), lines);
  }
  return html + "</div><p class='key'>Colours as above; dashed: the same vendor raw.</p>";
}

std::string sentence_of(const Comparison& comparison) {
  return fmt::format("<li>{}{}{}, {}: p50 {} against {} of {}: <b>{:.2f}×</b>; p99 {:.2f}×</li>",
                     escaped(comparison.claim), place_of(comparison).empty() ? "" : ", ",
                     place_of(comparison), escaped(comparison.subject),
                     figure_text(comparison.summary().p50, comparison.unit),
                     figure_text(comparison.rival_summary().p50, comparison.unit),
                     escaped(comparison.rival), comparison.ratio_p50(), comparison.ratio_p99());
}

std::string list_of(const char* title, const std::string& items, const char* nothing) {
  return fmt::format("<h3>{}</h3><ul>{}</ul>", title,
                     items.empty() ? fmt::format("<li>{}</li>", nothing) : items);
}

}  // namespace

std::string size_text(std::size_t size_bytes) {
  if (size_bytes >= 1 << 20) return fmt::format("{} MiB", size_bytes >> 20);
  if (size_bytes >= 1 << 10) return fmt::format("{} KiB", size_bytes >> 10);
  return fmt::format("{} B", size_bytes);
}

std::string place_of(const Comparison& comparison) {
  const auto& parameters = comparison.parameters;
  if (parameters.contains("placement")) {
    return variant_of(comparison) + ", " + parameters.at("placement").get<std::string>();
  }
  if (parameters.contains("size_bytes")) return size_text(size_of(comparison));
  if (parameters.contains("peers"))
    return fmt::format("{} peers, a process each", parameters.at("peers").get<std::size_t>());
  return parameters.contains("where") ? parameters.at("where").get<std::string>() : "";
}

std::string verdict_section(const std::vector<Comparison>& comparisons) {
  std::string beyond, slower, without_goal, faster;
  std::set<std::string> skipped, failed;
  for (const Comparison& comparison : comparisons) {
    if (!measured(comparison)) {
      (comparison.absence.failed ? failed : skipped)
          .insert(fmt::format("<li>{}, {} beside {}: {}</li>", escaped(comparison.claim),
                              escaped(comparison.subject), escaped(comparison.rival),
                              escaped(comparison.absence.reason)));
    } else if (is_beside_raw(comparison) && !has_goal(comparison)) {
      if (comparison.ratio_p50() > 1) without_goal += sentence_of(comparison);
    } else if (has_goal(comparison) && !is_of_matrix(comparison)) {
      (!meets_goal(comparison)      ? beyond
       : comparison.ratio_p50() > 1 ? slower
                                    : faster) += sentence_of(comparison);
    }
  }
  std::string html = list_of("Skein misses its goal", beyond, "Nowhere.") +
                     list_of("Skein loses, within its goal", slower, "Nowhere.") +
                     list_of("Skein loses, where there is no goal", without_goal, "Nowhere.") +
                     list_of("Skein is level or ahead", faster, "Nowhere.");
  html += rivals_verdict(comparisons);
  const auto list_reasons = [&](const char* title, const std::set<std::string>& reasons) {
    std::string items;
    for (const std::string& item : reasons) items += item;
    if (!items.empty()) html += list_of(title, items, "");
  };
  list_reasons("Failed, and not measured", failed);
  list_reasons("Not measured here", skipped);
  return "<section><h2>Where Skein loses</h2>" + html + "</section>";
}

std::string section_by_size(const std::string& claim, const Comparisons& comparisons) {
  return fmt::format("<section><h2>{}</h2>{}{}{}{}</section>", escaped(claim),
                     ratio_bars(comparisons), latency_panels(comparisons), tail_panels(comparisons),
                     table_of(comparisons));
}

std::string section_of_figures(const std::string& claim, const Comparisons& comparisons) {
  return fmt::format("<section><h2>{}</h2>{}</section>", escaped(claim), table_of(comparisons));
}

std::string section_of_times(const std::string& claim, const Comparisons& comparisons) {
  std::map<std::string, std::vector<const Comparison*>> by_place;
  for (const Comparison* comparison : comparisons)
    by_place[place_of(*comparison)].push_back(comparison);
  std::string html;
  for (const auto& [place, group] : by_place) {
    std::vector<Strip> strips;
    std::vector<std::pair<double, std::string>> marks;
    double low = 1e12, high = 0;
    for (const Comparison* comparison : group) {
      if (!measured(*comparison)) continue;
      strips.push_back({comparison->subject, colour_of(comparison->subject), comparison->samples});
      if (comparison->rival_samples.size() == 1) {
        marks = {{comparison->rival_samples[0], comparison->rival}};
      } else {
        strips.push_back({comparison->rival, "#999999", comparison->rival_samples});
      }
      for (const auto* samples : {&comparison->samples, &comparison->rival_samples}) {
        low = std::min(low, *std::min_element(samples->begin(), samples->end()));
        high = std::max(high, *std::max_element(samples->begin(), samples->end()));
      }
    }
    if (strips.empty()) continue;
    html += strip_plot(place.empty() ? claim : claim + ", " + place, Axis::times("time", low, high),
                       strips, marks);
  }
  return fmt::format("<section><h2>{}</h2>{}{}</section>", escaped(claim), html,
                     table_of(comparisons));
}

}  // namespace skein::benchmarks
