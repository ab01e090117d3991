#include "places.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "flight/angles.hpp"
#include "skein/error.hpp"

namespace reconnaissance {
namespace {

/// So many numbers, or so many more, from there on.
std::vector<double> numbers_in(const std::string& text, std::size_t count, const char* what,
                               std::size_t more = 0, std::size_t from = 0) {
  std::istringstream words(text.substr(from));
  const auto numbers = remaining_numbers(words);
  if (numbers && numbers->size() >= count && numbers->size() <= count + more) return *numbers;
  throw skein::InvalidArgument("'" + text + "' is no " + what);
}

Geodetic read_place(const std::vector<double>& numbers, const std::string& text) {
  const Geodetic place{numbers[0], numbers[1], numbers[2]};
  if (std::abs(place.latitude_deg) > 90 || std::abs(place.longitude_deg) > 180)
    throw skein::InvalidArgument("'" + text +
                                 "' is no place: a latitude is -90 to 90, a longitude -180 to 180");
  return place;
}

}  // namespace

std::vector<std::string> parts_of(const std::string& text, char separator) {
  constexpr const char* kBlank = " \t\r\n";
  const char separators[] = {separator, '\n', '\0'};
  std::vector<std::string> parts;
  for (std::size_t at = 0, end = 0; at < text.size(); at = end + 1) {
    end = std::min(text.find_first_of(separators, at), text.size());
    const auto begin = text.find_first_not_of(kBlank, at);
    if (begin >= end) continue;
    parts.push_back(text.substr(begin, text.find_last_not_of(kBlank, end - 1) + 1 - begin));
  }
  return parts;
}

std::optional<std::vector<double>> remaining_numbers(std::istream& words) {
  constexpr double kFurthest = 1e7;
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    double number = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, number);
    if (error != std::errc() || stop != end || !(std::abs(number) <= kFurthest))
      return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

RunwayText parse_runway(const std::string& text) {
  const auto numbers =
      numbers_in(text, 5, "runway; write `latitude longitude height course length`");
  if (numbers[4] <= 0) throw skein::InvalidArgument("'" + text + "': a runway has a length");
  return {read_place(numbers, text), course(radians(numbers[3])), numbers[4]};
}

std::vector<RunwayText> parse_runways(const std::string& text) {
  std::vector<RunwayText> runways;
  for (const std::string& each : parts_of(text, ';')) runways.push_back(parse_runway(each));
  return runways;
}

std::vector<SiteText> parse_sites(const std::string& text) {
  std::vector<SiteText> sites;
  for (const std::string& part : parts_of(text, ';')) {
    std::size_t split = 0;  // where the type's last word ends
    std::istringstream words(part);
    for (std::string word; words >> word;) {
      if (word.find_first_not_of("-.0123456789") == std::string::npos) break;
      split = part.find(word, split) + word.size();
    }
    const auto numbers = numbers_in(part, 3,
                                    "site; write `type latitude longitude active`, and behind it "
                                    "how near one that lies in wait lets the aircraft come",
                                    1, split);
    SiteText& site = sites.emplace_back();
    site = {part.substr(0, split), read_place({numbers[0], numbers[1], 0}, part), numbers[2]};
    if (numbers.size() == 3) continue;
    site.silent_beyond_m = numbers[3];
    if (site.silent_beyond_m <= 0)
      throw skein::InvalidArgument("'" + part + "': no aircraft comes nearer to a site than that");
  }
  return sites;
}

std::vector<IntruderText> parse_intruders(const std::string& text) {
  std::vector<IntruderText> intruders;
  for (const std::string& part : parts_of(text, ';')) {
    const auto numbers = numbers_in(part, 4, "intruder; write `seconds direction distance speed`");
    if (numbers[2] <= 0 || numbers[3] <= 0)
      throw skein::InvalidArgument("'" + part + "': an intruder has a distance and a speed");
    intruders.push_back({numbers[0], radians(numbers[1]), numbers[2], numbers[3]});
  }
  return intruders;
}

std::vector<FailureText> parse_failures(const std::string& text) {
  static const std::vector<std::string> kKinds{"none",  "off",  "stuck",   "garbage",
                                               "wrong", "slow", "delayed", "intermittent"};
  std::vector<FailureText> failures;
  for (const std::string& part : parts_of(text, ';')) {
    FailureText failure;
    std::istringstream words(part);
    std::string kind;
    words >> failure.set >> kind;
    const auto times = remaining_numbers(words);
    const bool whole = times && times->size() == 2 && times->front() < times->back();
    const auto found = std::find(kKinds.begin() + 1, kKinds.end(), kind);
    if (!whole || found == kKinds.end() || failure.set < 1 || failure.set > 3)
      throw skein::InvalidArgument(
          "'" + part +
          "' is no failure; write `set kind from until`, with a set of 1 to 3, and "
          "off, stuck, garbage, wrong, slow, delayed or intermittent; several are separated by "
          "semicolons");
    --failure.set;
    failure.from_s = times->front();
    failure.until_s = times->back();
    failure.kind = static_cast<SensorFailure>(found - kKinds.begin());
    failures.push_back(failure);
  }
  return failures;
}

std::vector<PlannerFailureText> parse_planner_failures(const std::string& text) {
  std::vector<PlannerFailureText> failures;
  for (const std::string& part : parts_of(text, ';')) {
    std::istringstream words(part);
    std::int32_t request = 0;
    std::string kind;
    const bool read(words >> request >> kind);
    if (!read || !(words >> std::ws).eof() || request < 1 ||
        (kind != "killed" && kind != "stopped"))
      throw skein::InvalidArgument("'" + part +
                                   "' is no failure of a planner; write `request kind`, with the "
                                   "number of a request, from 1, and killed or stopped");
    failures.push_back({static_cast<std::uint32_t>(request), kind == "stopped"});
  }
  return failures;
}

}  // namespace reconnaissance
