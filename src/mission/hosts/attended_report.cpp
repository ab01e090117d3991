#include "mission/hosts/attended_report.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>

#include "core/printable.hpp"

namespace skein::launch {
namespace {

using Kind = AttendedReport::Kind;

constexpr std::string_view kMark = "skein>";
constexpr std::array<std::string_view, 5> kKinds{"hello", "output", "event", "ready", "ended"};
constexpr std::string_view kNobody = "-";
constexpr std::size_t kLongestText = 32 * 1024;

/// Takes the next word from a line.
std::string_view next_word(std::string_view& rest) {
  const auto end = std::min(rest.find(' '), rest.size());
  const auto word = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return word;
}

std::optional<int> maybe_number(std::string_view word) {
  int number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

}  // namespace

std::string to_line(const AttendedReport& report) {
  const int number = report.kind == Kind::Event ? static_cast<int>(report.state) : report.exit_code;
  std::string line(kMark);
  line += ' ';
  line += kKinds[static_cast<std::size_t>(report.kind)];
  line += ' ';
  line += report.child.empty() ? kNobody : report.child;
  line += ' ' + std::to_string(number) + ' ';
  return line + printable(std::string_view(report.text).substr(0, kLongestText), kLongestText) +
         '\n';
}

std::optional<AttendedReport> maybe_report(std::string_view line) {
  if (next_word(line) != kMark) return std::nullopt;
  AttendedReport report;
  const auto kind = std::find(kKinds.begin(), kKinds.end(), next_word(line));
  if (kind == kKinds.end()) return std::nullopt;
  report.kind = static_cast<Kind>(kind - kKinds.begin());
  const auto child = next_word(line);
  if (child != kNobody) report.child = printable(child);
  const auto number = maybe_number(next_word(line));
  if (!number) return std::nullopt;
  if (report.kind == Kind::Event) {
    if (*number < 0 || *number > static_cast<int>(ChildState::Lost)) return std::nullopt;
    report.state = static_cast<ChildState>(*number);
  } else {
    report.exit_code = *number;
  }
  report.text = printable(line, line.size());
  return report;
}

}  // namespace skein::launch
