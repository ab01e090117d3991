#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Plots as SVG text, to stand inside an HTML page. Nothing external is referred to.
namespace skein::benchmarks {

struct Axis {
  std::string label;
  double low = 0;
  double high = 1;
  bool logarithmic = false;
  /// Where, and what stands there.
  std::vector<std::pair<double, std::string>> ticks{};

  /// An axis of times in microseconds, logarithmic, that has room for `low` to `high`.
  static Axis times(const std::string& label, double low, double high);
};

struct Line {
  std::string label;
  std::string colour;
  bool dashed = false;
  std::vector<std::pair<double, double>> points{};
};

/// A small panel; the legend is the page's.
std::string line_plot(const std::string& title, const Axis& x, const Axis& y,
                      const std::vector<Line>& lines);

struct Bar {
  std::string colour;
  double value = 0;
  /// A dot beside the bar: the same quantity at another percentile.
  std::optional<double> dot{};
};

struct BarGroup {
  std::string label;
  std::vector<Bar> bars{};
};

/// Bars from 0 up, with horizontal lines at `marks`.
std::string bar_plot(const std::string& title, const std::string& y_label,
                     const std::vector<BarGroup>& groups,
                     const std::vector<std::pair<double, std::string>>& marks);

struct Strip {
  std::string label;
  std::string colour;
  std::vector<double> values{};
};

/// Every value as a dot, one row a strip, the median as a stroke; vertical lines at `marks`.
std::string strip_plot(const std::string& title, const Axis& x, const std::vector<Strip>& strips,
                       const std::vector<std::pair<double, std::string>>& marks = {});

/// `12.3 µs`, `4.56 ms`, `1.02 s`.
std::string time_text(double time_us);

/// A figure of a Comparison, with its unit: a time, or `1234 octets`.
std::string figure_text(double figure, const std::string& unit);

/// For text inside HTML and SVG.
std::string escaped(const std::string& text);

}  // namespace skein::benchmarks
