#include "mission/scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace reconnaissance {
namespace {

// What is reported further from all sites is none of them.
constexpr double kNoSite_m = 5000;

/// The one that is nearest to a place, unless it is too far away.
template <class Item, class SiteOf = std::identity>
std::optional<std::size_t> nearest_to(const Local& place, const std::vector<Item>& sites,
                                      SiteOf site_of = {}) {
  std::optional<std::size_t> nearest;
  double least_m = kNoSite_m;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const double distance = map_distance_m(std::invoke(site_of, sites[i]).place, place);
    if (distance > least_m) continue;
    least_m = distance;
    nearest = i;
  }
  return nearest;
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
    if (reported >= conditions_.ordered_s) continue;
    ++reported;
    if (moment.in_view) ++in_view;
    squares_m2 += std::pow(map_distance_m(*moment.truth, *moment.reported), 2);
  }
  if (!first) {
    const std::string never = "the target was never found";
    return {{"found", false, never}, {"in view", false, never}, {"track", false, never}};
  }
  const double share = std::min(1.0, in_view / conditions_.ordered_s);
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
  // For each report the site that it is nearest to.
  std::vector<std::optional<std::size_t>> belongs;
  for (const Site& each : reported) belongs.push_back(nearest_to(each.place, truth));
  std::size_t found = 0;
  double worst_m = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Site& site = truth[i];
    const Site* best = nullptr;
    double nearest_m = kNoSite_m;
    for (std::size_t j = 0; j < reported.size(); ++j) {
      const double distance = map_distance_m(site.place, reported[j].place);
      if (belongs[j] != i || distance > nearest_m) continue;
      nearest_m = distance;
      best = &reported[j];
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
  const std::size_t strangers = reported.size() - found;
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

void ReportDelays::truth(double now_s, const std::vector<Heard>& sites) {
  sites_.resize(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    sites_[i].site = sites[i].site;
    if (sites[i].heard && !sites_[i].heard_s) sites_[i].heard_s = now_s;
  }
}

void ReportDelays::report(double now_s, const std::vector<Site>& reported) {
  for (const Site& each : reported) {
    const auto nearest = nearest_to(each.place, sites_, &Times::site);
    if (nearest && !sites_[*nearest].reported_s) sites_[*nearest].reported_s = now_s;
  }
}

Check ReportDelays::check(double within_s) const {
  std::vector<std::string> late;
  double longest_s = 0;
  std::size_t reported = 0;
  for (const Times& each : sites_) {
    if (!each.heard_s || !each.reported_s) {
      late.push_back(each.site.kind + (each.heard_s ? " never" : " never heard"));
      continue;
    }
    ++reported;
    const double delay_s = std::max(0.0, *each.reported_s - *each.heard_s);
    longest_s = std::max(longest_s, delay_s);
    if (delay_s > within_s)
      late.push_back(fmt::format("{} after {:.0f} s", each.site.kind, delay_s));
  }
  return {
      "sites reported", !sites_.empty() && late.empty(),
      fmt::format(
          "{} of {} reported, at most {:.0f} s after they could first be heard, allowed {:.0f}{}",
          reported, sites_.size(), longest_s, within_s, late.empty() ? "" : ": " + joined(late))};
}

}  // namespace reconnaissance
