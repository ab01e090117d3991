#include "feature_findings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <span>

#include "core/printable.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"

namespace skein::command {
namespace {

using introspection::Attempt;
using introspection::Decision;
using introspection::Outcome;
using Requests = FeatureFindings::Requests;

constexpr std::size_t kLeastForConstant = 10;
constexpr std::size_t kLeastForUseless = 50;
constexpr std::size_t kLeastInGroup = 10;
constexpr std::size_t kMostGroups = 8;
constexpr std::size_t kMostStrata = 3;
/// A feature that has nothing to do with the outcomes is taken for one that has so often.
constexpr double kChance = 0.01;
/// What a failure counts as, in times of what it took: the history counts alike.
constexpr double kPenalty = 10;

/// Where a request lacks the feature.
constexpr float kMissing = -std::numeric_limits<float>::infinity();

/// A number for some of the requests.
struct Target {
  std::vector<std::pair<std::size_t, double>> values;  // request, number
};

/// The groups of a feature's values: each value where they are few, otherwise as many quantiles as
/// there are requests for. Two equal values are in one group.
std::vector<std::size_t> grouped(std::span<const float> values, std::size_t most) {
  std::vector<float> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  std::vector<float> starts(sorted);
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  if (starts.size() > most) {
    starts.clear();
    for (std::size_t i = 0; i < most; ++i) starts.push_back(sorted[i * sorted.size() / most]);
    starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  }
  std::vector<std::size_t> groups;
  groups.reserve(values.size());
  for (const float value : values) {
    const auto behind = std::ranges::upper_bound(starts, value);
    groups.push_back(static_cast<std::size_t>(behind - starts.begin()) - 1);
  }
  return groups;
}

/// The upper tail of the chi-square distribution (Wilson and Hilferty 1931).
double chance_of(double chi_square, double freedom) {
  if (freedom <= 0) return 1;
  const double spread = 2 / (9 * freedom);
  const double z = (std::cbrt(chi_square / freedom) - (1 - spread)) / std::sqrt(spread);
  return std::erfc(z / std::sqrt(2)) / 2;
}

/// Kruskal and Wallis (1952): by ranks, so that no scale matters, neither the feature's nor the
/// target's.
struct Test {
  double chi_square = 0;
  double freedom = 0;

  struct Ranked {
    double value;
    std::size_t group;
  };

  void add(std::vector<Ranked> rows) {
    std::ranges::sort(rows, {}, &Ranked::value);
    const auto count = static_cast<double>(rows.size());
    std::map<std::size_t, std::pair<double, double>> groups;  // count, sum of ranks
    double ties = 0;
    for (std::size_t i = 0; i < rows.size();) {
      std::size_t end = i;
      while (end < rows.size() && rows[end].value == rows[i].value) ++end;
      const auto equal = static_cast<double>(end - i);
      ties += equal * equal * equal - equal;
      for (const double rank = static_cast<double>(i + end + 1) / 2; i < end; ++i) {
        groups[rows[i].group].first += 1;
        groups[rows[i].group].second += rank;
      }
    }
    const double spread = 1 - ties / (count * count * count - count);
    if (groups.size() < 2 || spread <= 0) return;
    double sum = 0;
    for (const auto& [group, ranks] : groups) sum += ranks.second * ranks.second / ranks.first;
    chi_square += (12 / (count * (count + 1)) * sum - 3 * (count + 1)) / spread;
    freedom += static_cast<double>(groups.size() - 1);
  }
};

/// How probable it is that the target goes so well with the groups if it has nothing to do with
/// them, within each of the strata.
double chance_of(const Target& target, const std::vector<std::size_t>& groups,
                 const std::vector<std::size_t>& strata) {
  std::map<std::size_t, std::vector<Test::Ranked>> rows;
  for (const auto& [request, value] : target.values)
    rows[strata[request]].push_back({value, groups[request]});
  Test test;
  for (auto& [stratum, each] : rows) test.add(std::move(each));
  return chance_of(test.chi_square, test.freedom);
}

bool ended_by_itself(const Attempt& attempt) {
  return attempt.outcome != Outcome::Cancelled && attempt.outcome != Outcome::Preselected;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.15g", value);
  return text;
}

struct Column {
  std::string name;
  std::vector<float> values;  // as the history has them
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  Column(std::string name_, const Requests& requests) : name(std::move(name_)) {
    for (const auto& request : requests) {
      const auto found = request.features.find(name);
      if (found == request.features.end()) {
        values.push_back(kMissing);
        continue;
      }
      values.push_back(static_cast<float>(found->second));
      least = std::min(least, found->second);
      most = std::max(most, found->second);
    }
  }

  bool varies() const {
    return std::ranges::any_of(values, [&](float value) { return value != values.front(); });
  }
};

/// What the Head could learn from features: whom it chose, and what each CSP took and was worth.
std::vector<Target> targets_of(const Requests& requests) {
  std::map<std::string, Target> chosen, costs, qualities;
  for (const auto& request : requests) chosen[request.chosen];
  for (std::size_t i = 0; i < requests.size(); ++i) {
    for (auto& [csp, target] : chosen)
      target.values.emplace_back(i, requests[i].chosen == csp ? 1 : 0);
    for (const auto& run : requests[i].runs) {
      if (run.cost) costs[run.csp].values.emplace_back(i, *run.cost);
      if (run.quality) qualities[run.csp].values.emplace_back(i, *run.quality);
    }
  }
  std::vector<Target> targets;
  for (auto* map : {&chosen, &costs, &qualities}) {
    for (auto& [csp, target] : *map) targets.push_back(std::move(target));
  }
  return targets;
}

/// Whether some target goes with the feature, in all requests, or in those that are alike in
/// another feature.
bool tells(std::span<const float> feature, const std::vector<std::span<const float>>& others,
           const std::vector<Target>& targets) {
  const std::size_t most = std::clamp(feature.size() / kLeastInGroup, std::size_t{2}, kMostGroups);
  const auto groups = grouped(feature, most);
  std::vector<std::vector<std::size_t>> strata{std::vector<std::size_t>(feature.size(), 0)};
  for (const auto& other : others) strata.push_back(grouped(other, kMostStrata));
  const double least = kChance / static_cast<double>(targets.size() * strata.size());
  return std::ranges::any_of(targets, [&](const Target& target) {
    return std::ranges::any_of(
        strata, [&](const auto& each) { return chance_of(target, groups, each) < least; });
  });
}

/// Of one that is the same number to the Head in all requests.
std::string constant_finding(const Column& column) {
  const std::string count = std::to_string(column.values.size());
  if (column.least == column.most) {
    return "is " + number(column.least) + " in all " + count +
           " decisions, and tells no request from another: leave it out, or give what differs "
           "from request to request";
  }
  return "varies only from " + number(column.least) + " to " + number(column.most) + " in " +
         count +
         " decisions, which is one number to the Head (it keeps 24 bits): subtract what all have "
         "in common";
}

std::string finding(const Column& column, const std::vector<Column>& all,
                    const std::vector<Target>& targets) {
  const std::size_t count = column.values.size();
  if (!column.varies()) return count < kLeastForConstant ? "" : constant_finding(column);
  if (count < kLeastForUseless) return {};
  std::vector<std::span<const float>> others;
  for (const Column& other : all) {
    if (&other != &column && other.varies()) others.emplace_back(other.values);
  }
  if (tells(column.values, others, targets)) return {};
  return "varies, but in " + std::to_string(count) +
         " decisions neither the choice of a CSP nor any CSP's time, success or quality goes with "
         "it: leave it out, or give what makes requests easy or hard for a CSP";
}

std::vector<Column> columns_of(const Requests& requests) {
  std::set<std::string> names;
  for (const auto& request : requests) {
    for (const auto& [name, value] : request.features) names.insert(name);
  }
  std::vector<Column> columns;
  for (const std::string& name : names) columns.emplace_back(name, requests);
  return columns;
}

}  // namespace

void FeatureFindings::add(const Decision& decision) {
  if (decision.features.empty()) return;
  Request request;
  for (const auto& feature : decision.features) request.features[feature.name] = feature.value;
  if (!decision.attempts.empty()) request.chosen = decision.attempts.front().csp;
  for (const Attempt& attempt : decision.attempts) {
    Run run{attempt.csp, std::nullopt, std::nullopt};
    if (ended_by_itself(attempt)) {
      run.cost =
          static_cast<double>(attempt.took) * (attempt.outcome == Outcome::Accepted ? 1 : kPenalty);
    }
    if (!attempt.quality.empty()) run.quality = attempt.quality.front();
    request.runs.push_back(std::move(run));
  }
  Requests& all = requests_[{decision.entity, decision.service}];
  all.push_back(std::move(request));
  if (all.size() > kMostDecisions) all.pop_front();
}

std::vector<std::string> FeatureFindings::sentences() const {
  std::vector<std::string> sentences;
  for (const auto& [place, requests] : requests_) {
    const auto columns = columns_of(requests);
    const auto targets = targets_of(requests);
    for (const Column& column : columns) {
      const std::string what = finding(column, columns, targets);
      if (what.empty()) continue;
      sentences.push_back(printable(place.first) + ", " + printable(place.second) +
                          ": the feature '" + printable(column.name) + "' " + what);
    }
  }
  return sentences;
}

}  // namespace skein::command
