#include "mission/emitters.hpp"

#include <algorithm>
#include <cmath>

namespace reconnaissance {
namespace {

constexpr double kReachDeviations = 5;
constexpr double kPlaced_m = 1000;

double offset_m(const ReportedEmitter& report, const HeardEmitter& heard) {
  return map_distance_m(heard.place, report.place);
}

}  // namespace

EmitterMatch match_emitters(const std::vector<ReportedEmitter>& reports,
                            const std::vector<HeardEmitter>& heard) {
  struct Pair {
    double distance_m;
    std::size_t report, emitter;
  };
  std::vector<Pair> pairs;
  for (std::size_t report = 0; report < reports.size(); ++report) {
    for (std::size_t emitter = 0; emitter < heard.size(); ++emitter) {
      const double margin_m = reports[report].margin_m;
      const double apart_m = offset_m(reports[report], heard[emitter]);
      if (apart_m <= margin_m && heard[emitter].deviation_m <= margin_m)
        pairs.push_back({apart_m, report, emitter});
    }
  }
  std::ranges::stable_sort(pairs, {}, &Pair::distance_m);
  EmitterMatch match{std::vector<std::optional<std::size_t>>(reports.size()), {}};
  std::vector<bool> taken(heard.size());
  for (const Pair& each : pairs) {
    if (match.of_reports[each.report] || taken[each.emitter]) continue;
    match.of_reports[each.report] = each.emitter;
    taken[each.emitter] = true;
  }
  for (std::size_t emitter = 0; emitter < heard.size(); ++emitter) {
    bool may_be_reported = taken[emitter] || heard[emitter].deviation_m > kPlaced_m;
    for (std::size_t report = 0; report < reports.size(); ++report) {
      const double reach_m =
          reports[report].margin_m + kReachDeviations * heard[emitter].deviation_m;
      may_be_reported |=
          !match.of_reports[report] && offset_m(reports[report], heard[emitter]) <= reach_m;
    }
    if (!may_be_reported) match.unreported.push_back(emitter);
  }
  return match;
}

}  // namespace reconnaissance
