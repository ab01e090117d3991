#include "harness/comparison.hpp"

#include <cmath>
#include <fstream>

#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

using nlohmann::json;

void put_figures(json& object, const std::string& prefix, const Summary& summary,
                 const std::string& unit) {
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
  const Summary own = comparison.summary();
  const Summary rival = comparison.rival_summary();
  json object{{"claim", comparison.claim},     {"subject", comparison.subject},
              {"rival", comparison.rival},     {"parameters", comparison.parameters},
              {"unit", comparison.unit},       {"samples", own.samples},
              {"rival_samples", rival.samples}};
  put_figures(object, "", own, comparison.unit);
  put_figures(object, "rival_", rival, comparison.unit);
  object["ratio_p50"] = ratio(comparison, 0.5);
  object["ratio_p99"] = ratio(comparison, 0.99);
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

void write_results(const std::vector<Comparison>& comparisons, const std::string& path) {
  json all = json::array();
  for (const Comparison& comparison : comparisons) all.push_back(to_json(comparison));
  std::ofstream file(path);
  file << all.dump(2) << '\n';
  if (!file.flush()) throw Internal(path + " cannot be written; is its folder there and writable?");
}

}  // namespace skein::benchmarks
