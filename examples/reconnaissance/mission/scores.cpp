#include "mission/scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace reconnaissance {
namespace {

// What is reported further from all sites is none of them.
constexpr double kNoSite_m = 5000;

double distance_m(const Local& a, const Local& b) {
  return std::hypot(a.north_m - b.north_m, a.east_m - b.east_m);
}

std::string joined(const std::vector<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

void PursuitScore::truth(std::int64_t second, const Local& target, bool in_view) {
  moments_[second].truth = target;
  moments_[second].in_view = in_view;
}

void PursuitScore::report(std::int64_t second, const std::optional<Local>& target) {
  moments_[second].reported = target;
}

std::vector<Check> PursuitScore::checks() const {
  std::optional<std::int64_t> first, last;
  std::int64_t longest_gap = 0;
  double reported = 0, in_view = 0, squares_m2 = 0;
  for (const auto& [second, moment] : moments_) {
    if (!moment.truth || !moment.reported) continue;
    if (!first) first = second;
    if (last) longest_gap = std::max(longest_gap, second - *last - 1);
    last = second;
    // More than was ordered does not make up for what was not seen.
    if (reported == conditions_.ordered_s) continue;
    ++reported;
    if (moment.in_view) ++in_view;
    squares_m2 += std::pow(distance_m(*moment.truth, *moment.reported), 2);
  }
  if (!first) {
    const std::string never = "the target was never found";
    return {{"found", false, never}, {"in view", false, never}, {"track", false, never}};
  }
  const double share = in_view / conditions_.ordered_s;
  const double error_m = std::sqrt(squares_m2 / reported);
  return {{"found", true, fmt::format("the target was found after {} s of the mission", *first)},
          {"in view", share >= conditions_.least_in_view,
           fmt::format("truly in the image for {:.1f} % of {:.0f} s, at least {:.1f}", 100 * share,
                       conditions_.ordered_s, 100 * conditions_.least_in_view)},
          {"track", error_m <= conditions_.greatest_error_m,
           fmt::format("{:.1f} m from where the target truly was (root mean square over {:.0f} s), "
                       "at most {:.1f}; interrupted for {} s at most",
                       error_m, reported, conditions_.greatest_error_m, longest_gap)}};
}

std::vector<Check> site_checks(const std::vector<Site>& truth, const std::vector<Site>& reported,
                               double within_m) {
  std::vector<std::string> missed, mistaken, displaced;
  std::vector<bool> belongs(reported.size());
  std::size_t found = 0;
  double worst_m = 0;
  for (const Site& site : truth) {
    // The nearest report of those that are nearest to this site.
    const Site* best = nullptr;
    double nearest_m = kNoSite_m;
    for (std::size_t i = 0; i < reported.size(); ++i) {
      const double distance = distance_m(site.place, reported[i].place);
      const bool nearer_to_another = std::ranges::any_of(truth, [&](const Site& other) {
        return distance_m(other.place, reported[i].place) < distance;
      });
      if (nearer_to_another || distance > kNoSite_m) continue;
      if (distance < nearest_m) {
        nearest_m = distance;
        best = &reported[i];
      }
      belongs[i] = true;
    }
    if (!best) {
      missed.push_back(site.kind);
      continue;
    }
    ++found;
    worst_m = std::max(worst_m, nearest_m);
    if (best->kind != site.kind) mistaken.push_back(site.kind + " for " + best->kind);
    if (nearest_m > within_m)
      displaced.push_back(fmt::format("{} by {:.0f} m", site.kind, nearest_m));
  }
  const auto strangers = std::ranges::count(belongs, false);
  const bool all = missed.empty() && !truth.empty();
  const std::string others =
      strangers ? fmt::format("; {} reported where there is none", strangers) : "";
  return {{"sites found", all && strangers == 0,
           fmt::format("{} of {}{}{}", found, truth.size(),
                       missed.empty() ? "" : ", not " + joined(missed), others)},
          {"sites classified", all && mistaken.empty(),
           mistaken.empty() ? fmt::format("{} of {}, each that was found", found, truth.size())
                            : joined(mistaken)},
          {"sites located", all && displaced.empty(),
           found == 0 ? "none"
                      : fmt::format("{} of {} found, the worst {:.0f} m from where it is, at most "
                                    "{:.0f}{}",
                                    found, truth.size(), worst_m, within_m,
                                    displaced.empty() ? "" : ": " + joined(displaced))}};
}

}  // namespace reconnaissance
