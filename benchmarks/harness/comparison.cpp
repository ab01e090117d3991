#include "harness/comparison.hpp"

#include <cmath>
namespace skein::benchmarks {
namespace {

using nlohmann::json;

constexpr std::size_t kFew = 500;

void put_figures(json& object, const std::string& prefix, const std::vector<double>& samples,
                 const std::string& unit) {
  const Summary summary = summarize(samples);
  object[prefix + "samples"] = summary.samples;
  if (!samples.empty() && samples.size() <= kFew) object[prefix + "values"] = samples;
  const auto put = [&](const char* name, double figure) {
    object[prefix + name + '_' + unit] = summary.samples == 0 ? json(nullptr) : json(figure);
  };
  put("p50", summary.p50);
  put("p90", summary.p90);
  put("p95", summary.p95);
  put("p99", summary.p99);
  put("p999", summary.p999);
}

json ratio(const Comparison& comparison, double q) {
  if (comparison.samples.empty() || comparison.rival_samples.empty()) return nullptr;
  const double ratio =
      ratio_of_quantiles(comparison.samples, comparison.rival_samples, comparison.rounds, q);
  return std::isfinite(ratio) && ratio > 0 ? json(ratio) : json(nullptr);
}

}  // namespace

json to_json(const Comparison& comparison) {
  json object{{"claim", comparison.claim},
              {"subject", comparison.subject},
              {"rival", comparison.rival},
              {"parameters", comparison.parameters},
              {"unit", comparison.unit}};
  put_figures(object, "", comparison.samples, comparison.unit);
  put_figures(object, "rival_", comparison.rival_samples, comparison.unit);
  object["ratio_p50"] = ratio(comparison, 0.5);
  object["ratio_p99"] = ratio(comparison, 0.99);
  if (!comparison.goal.empty()) object["goal"] = comparison.goal;
  if (comparison.goal_p50) object["goal_p50"] = *comparison.goal_p50;
  if (comparison.goal_p99) object["goal_p99"] = *comparison.goal_p99;
  if (const Absence& absence = comparison.absence)
    object[absence.failed ? "failed" : "skipped"] = absence.reason;
  return object;
}

void fill(Comparison& comparison, const Outcome& own, const Outcome& rival) {
  comparison.absence = graver(own.absence, rival.absence);
  if (comparison.absence) return;
  comparison.samples = own.samples;
  comparison.rival_samples = rival.samples;
  if (own.rounds == rival.rounds) comparison.rounds = own.rounds;
}

void append(std::vector<Comparison>& all, std::vector<Comparison> more) {
  for (Comparison& comparison : more) all.push_back(std::move(comparison));
}

}  // namespace skein::benchmarks
