#include "report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/statistics.hpp"

namespace skein::benchmarks {
namespace {

/// The area inside the axes, in the plot's own units.
struct Frame {
  double left, top, width, height;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

double share_of(const Axis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return std::log(value / axis.low) / std::log(axis.high / axis.low);
}
double x_at(const Frame& frame, const Axis& axis, double value) {
  return frame.left + frame.width * share_of(axis, value);
}
double y_at(const Frame& frame, const Axis& axis, double value) {
  return frame.bottom() - frame.height * share_of(axis, value);
}

std::string text(double x, double y, const std::string& content, const char* anchor,
                 const char* kind = "tick") {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' class='{}'>{}</text>", x, y,
                     anchor, kind, escaped(content));
}

std::string stroke(double x1, double y1, double x2, double y2, const char* kind) {
  return fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' class='{}'/>", x1, y1,
                     x2, y2, kind);
}

std::string open(double width, double height, const std::string& title) {
  return fmt::format(
             "<svg viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' role='img' "
             "aria-label='{2}'>",
             width, height, escaped(title)) +
         text(8, 16, title, "start", "title");
}

std::string x_axis(const Frame& frame, const Axis& axis) {
  std::string svg;
  for (const auto& [at, label] : axis.ticks) {
    const double x = x_at(frame, axis, at);
    svg += stroke(x, frame.top, x, frame.bottom(), "grid") +
           text(x, frame.bottom() + 15, label, "middle");
  }
  return svg +
         text(frame.left + frame.width / 2, frame.bottom() + 31, axis.label, "middle", "label");
}

std::string y_axis(const Frame& frame, const Axis& axis) {
  std::string svg;
  for (const auto& [at, label] : axis.ticks) {
    const double y = y_at(frame, axis, at);
    svg +=
        stroke(frame.left, y, frame.right(), y, "grid") + text(frame.left - 5, y + 4, label, "end");
  }
  return svg;
}

std::string polyline(const Frame& frame, const Axis& x, const Axis& y, const Line& line) {
  std::string points, dots;
  for (const auto& [at, value] : line.points) {
    const double dot_x = x_at(frame, x, at), dot_y = y_at(frame, y, value);
    points += fmt::format("{:.1f},{:.1f} ", dot_x, dot_y);
    dots += fmt::format(
        "<circle cx='{:.1f}' cy='{:.1f}' r='2.4' fill='{}'><title>{}: {}</title></circle>", dot_x,
        dot_y, line.colour, escaped(line.label), time_text(value));
  }
  return fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='1.8'{}/>", points,
                     line.colour, line.dashed ? " stroke-dasharray='5 4'" : "") +
         dots;
}

std::vector<std::pair<double, std::string>> even_ticks(double high) {
  double step = 0.25;
  while (high / step > 8) step *= 2;
  std::vector<std::pair<double, std::string>> ticks;
  for (double at = 0; at <= high + 1e-9; at += step)
    ticks.emplace_back(at, fmt::format("{:g}", at));
  return ticks;
}

}  // namespace

Axis Axis::times(const std::string& label, double low, double high) {
  Axis axis{label, std::pow(10, std::floor(std::log10(low))),
            std::pow(10, std::ceil(std::log10(high))), true};
  // A decade that is nearly empty is cut.
  if (axis.high / high > 4) axis.high = high * 1.5;
  if (low / axis.low > 4) axis.low = low / 1.5;
  for (double decade = 1e-1; decade <= axis.high; decade *= 10) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double at = decade * factor;
      const bool crowded = axis.high / axis.low > 300 && factor != 1;
      if (at >= axis.low && at <= axis.high * 1.001 && !crowded)
        axis.ticks.emplace_back(at, time_text(at));
    }
  }
  return axis;
}

std::string line_plot(const std::string& title, const Axis& x, const Axis& y,
                      const std::vector<Line>& lines) {
  const Frame frame{62, 28, 290, 190};
  std::string svg = open(370, 260, title) + y_axis(frame, y) + x_axis(frame, x);
  for (const Line& line : lines) svg += polyline(frame, x, y, line);
  return svg + "</svg>";
}

std::string bar_plot(const std::string& title, const std::string& y_label,
                     const std::vector<BarGroup>& groups,
                     const std::vector<std::pair<double, std::string>>& marks) {
  double high = 1.4;
  for (const BarGroup& group : groups) {
    for (const Bar& bar : group.bars)
      high = std::max({high, bar.value * 1.1, bar.dot.value_or(0) * 1.1});
  }
  high = std::min(high, 4.0);
  const Axis y{y_label, 0, high, false, even_ticks(high)};
  const Frame frame{46, 34, 680, 230};
  std::string svg =
      open(790, 300, title) + text(8, 30, y_label, "start", "label") + y_axis(frame, y);
  const double group_width =
      frame.width / static_cast<double>(std::max<std::size_t>(groups.size(), 1));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto& bars = groups[g].bars;
    const double left = frame.left + group_width * static_cast<double>(g);
    const double width =
        group_width * 0.84 / static_cast<double>(std::max<std::size_t>(bars.size(), 1));
    for (std::size_t b = 0; b < bars.size(); ++b) {
      const Bar& bar = bars[b];
      const double x = left + group_width * 0.08 + width * static_cast<double>(b);
      const double top = y_at(frame, y, std::min(bar.value, high));
      svg += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}'/>",
                         x, top, width * 0.8, frame.bottom() - top, bar.colour);
      svg += text(x + width * 0.4, top - 4, fmt::format("{:.2f}", bar.value), "middle", "value");
      if (bar.dot) {
        svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3' class='dot'/>", x + width * 0.4,
                           y_at(frame, y, std::min(*bar.dot, high)));
      }
    }
    svg += text(left + group_width / 2, frame.bottom() + 17, groups[g].label, "middle", "label");
  }
  for (const auto& [at, label] : marks) {
    svg += stroke(frame.left, y_at(frame, y, at), frame.right(), y_at(frame, y, at), "mark") +
           text(frame.right() + 4, y_at(frame, y, at) + 4, label, "start");
  }
  return svg + "</svg>";
}

std::string strip_plot(const std::string& title, const Axis& x, const std::vector<Strip>& strips,
                       const std::vector<std::pair<double, std::string>>& marks) {
  constexpr double kRow = 26;
  const Frame frame{210, 30, 500, kRow * static_cast<double>(strips.size())};
  std::string svg = open(790, frame.bottom() + 44, title) + x_axis(frame, x);
  for (std::size_t row = 0; row < strips.size(); ++row) {
    const Strip& strip = strips[row];
    const double middle = frame.top + kRow * (static_cast<double>(row) + 0.5);
    svg += text(frame.left - 8, middle + 4, strip.label, "end", "label");
    for (std::size_t i = 0; i < strip.values.size(); ++i) {
      const double offset =
          (static_cast<double>(i * 7 % 11) - 5) * 1.4;  // so that dots do not hide dots
      svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.6' fill='{}' fill-opacity='0.6'/>",
                         x_at(frame, x, strip.values[i]), middle + offset, strip.colour);
    }
    if (strip.values.empty()) continue;
    const double median = x_at(frame, x, summarize(strip.values).p50);
    svg += stroke(median, middle - 10, median, middle + 10, "median");
  }
  for (const auto& [at, label] : marks) {
    const double place = x_at(frame, x, at);
    svg += stroke(place, frame.top - 4, place, frame.bottom(), "mark") +
           text(place, frame.top - 7, label, "middle");
  }
  return svg + "</svg>";
}

std::string time_text(double time_us) {
  if (time_us >= 1e6) return fmt::format("{:.3g} s", time_us / 1e6);
  if (time_us >= 1e3) return fmt::format("{:.3g} ms", time_us / 1e3);
  return fmt::format("{:.3g} µs", time_us);
}

std::string figure_text(double figure, const std::string& unit) {
  return unit == "us" ? time_text(figure) : fmt::format("{:.0f} {}", figure, unit);
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '\'':
        result += "&#39;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

}  // namespace skein::benchmarks
