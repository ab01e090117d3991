#include "skein/entity/history.hpp"

#include <algorithm>
#include <cmath>

namespace skein {
namespace {

constexpr std::size_t kSurprises = 5;
constexpr double kSurprise = 2;
// A run so many runs ago is as far away as one on a request with nothing in common.
constexpr double kHorizon = 2560;

double value_of(const Features& features, const Feature& like, std::size_t index) {
  if (index < features.size() && features[index].name == like.name) return features[index].value;
  for (const Feature& feature : features) {
    if (feature.name == like.name) return feature.value;
  }
  return std::nan("");
}

// The mean relative difference (Canberra), 0 to 1 for values of one sign: no scale needs to be
// known.
double difference(const Features& request, const Features& sample) {
  double sum = 0;
  for (std::size_t i = 0; i < request.size(); ++i) {
    const double here = request[i].value;
    const double there = value_of(sample, request[i], i);
    if (here == there) continue;
    const double part = std::abs(here - there) / (std::abs(here) + std::abs(there));
    sum += std::isfinite(part) ? part : 1;
  }
  return request.empty() ? 0 : sum / static_cast<double>(request.size());
}

using Samples = std::vector<const History::Sample*>;

Samples newest(const std::deque<History::Sample>& samples) {
  Samples found;
  for (auto each = samples.rbegin(); each != samples.rend() && found.size() < History::kNeighbours;
       ++each) {
    found.push_back(&*each);
  }
  return found;
}

Samples nearest(const std::deque<History::Sample>& samples, const Features& features) {
  if (features.empty()) return newest(samples);
  std::vector<std::pair<double, std::size_t>> ranked;  // by distance, then by age
  for (std::size_t age = 0; age < samples.size(); ++age) {
    const auto& sample = samples[samples.size() - 1 - age];
    ranked.emplace_back(difference(features, sample.features) + static_cast<double>(age) / kHorizon,
                        age);
  }
  const std::size_t count = std::min(ranked.size(), History::kNeighbours);
  const auto end = ranked.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(ranked.begin(), end, ranked.end());
  Samples found;
  for (auto each = ranked.begin(); each != end; ++each) {
    found.push_back(&samples[samples.size() - 1 - each->second]);
  }
  return found;
}

// By nearest rank.
std::optional<Duration> quantile(const std::vector<Duration>& sorted, double share) {
  if (sorted.empty()) return std::nullopt;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(rank) - 1];
}

void predict_times(Prediction& prediction, const Samples& samples) {
  std::vector<Duration> times;
  for (const auto* sample : samples) {
    if (sample->late) times.push_back(2 * sample->took);
    if (sample->accepted) times.push_back(sample->took);
  }
  std::sort(times.begin(), times.end());
  prediction.median = quantile(times, 0.5);
  prediction.q95 = quantile(times, 0.95);
}

void predict_results(Prediction& prediction, const Samples& samples) {
  double accepted = 0, measured = 0, quality = 0;
  for (const auto* sample : samples) {
    accepted += sample->accepted ? 1 : 0;
    measured += sample->quality ? 1 : 0;
    quality += sample->quality.value_or(0);
  }
  prediction.reliability = (accepted + 1) / static_cast<double>(samples.size() + 1);
  if (measured > 0) prediction.quality = quality / measured;
}

}  // namespace

std::optional<Prediction> History::predict(const std::string& interface, const std::string& csp,
                                           const Features& features) const {
  const auto found = records_.find({interface, csp});
  if (found == records_.end()) return std::nullopt;
  const Samples samples = nearest(found->second.samples, features);
  Prediction prediction;
  prediction.samples = samples.size();
  prediction.idle = decisions(interface).made - found->second.samples.back().decision;
  predict_times(prediction, samples);
  predict_results(prediction, samples);
  return prediction;
}

void History::note_surprise(Record& record, const Prediction& before, const Sample& sample) {
  if (!before.median || !(sample.accepted || sample.late)) return;
  const double ratio = static_cast<double>(sample.took.count()) /
                       std::max(1.0, static_cast<double>(before.median->count()));
  if (ratio > kSurprise) {
    record.surprises = std::max(record.surprises, 0) + 1;
  } else if (ratio < 1 / kSurprise && !sample.late) {
    record.surprises = std::min(record.surprises, 0) - 1;
  } else {
    record.surprises = 0;
  }
}

void History::add(const std::string& interface, const std::string& csp, Sample sample) {
  const auto before = predict(interface, csp, sample.features);
  Record& record = records_[{interface, csp}];
  if (before) note_surprise(record, *before, sample);
  sample.decision = decisions(interface).made;
  record.samples.push_back(std::move(sample));
  if (static_cast<std::size_t>(std::abs(record.surprises)) >= kSurprises) {
    while (record.samples.size() > kSurprises) record.samples.pop_front();
    record.surprises = 0;
  }
  if (record.samples.size() > kKept) record.samples.pop_front();
}

void History::count(const std::string& interface, bool explored) {
  Decisions& decisions = decisions_[interface];
  ++decisions.made;
  decisions.explored += explored ? 1 : 0;
}

History::Decisions History::decisions(const std::string& interface) const {
  const auto found = decisions_.find(interface);
  return found == decisions_.end() ? Decisions() : found->second;
}

}  // namespace skein
