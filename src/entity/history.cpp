#include "skein/detail/history.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace skein {
namespace {

constexpr std::size_t kSurprises = 5;
constexpr double kSurprise = 2;
// Below this a change of threads and the system's load count for more than the CSP.
constexpr Duration kShortest = std::chrono::microseconds(100);
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

/// The nearest samples, by distance and then by age.
class Nearest {
 public:
  bool full() const { return count_ == kept_.size(); }
  /// Of the farthest one.
  double reach() const { return kept_[count_ - 1].first; }
  std::size_t size() const { return count_; }

  /// Those that come later are older.
  void offer(double distance, const History::Sample& sample) {
    if (full() && distance >= reach()) return;
    std::size_t place = full() ? count_ - 1 : count_++;
    for (; place > 0 && kept_[place - 1].first > distance; --place) kept_[place] = kept_[place - 1];
    kept_[place] = {distance, &sample};
  }

  const History::Sample& operator[](std::size_t index) const { return *kept_[index].second; }

 private:
  std::array<std::pair<double, const History::Sample*>, History::kNeighbours> kept_;
  std::size_t count_ = 0;
};

Nearest nearest(const std::deque<History::Sample>& samples, const Features& features) {
  Nearest found;
  std::size_t age = 0;
  for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample, ++age) {
    const double distance = static_cast<double>(age) / kHorizon;
    if (found.full() && distance >= found.reach()) break;  // and so are all that are older
    found.offer(difference(features, sample->features) + distance, *sample);
  }
  return found;
}

// By nearest rank.
std::optional<Duration> quantile(std::span<const Duration> sorted, double share) {
  if (sorted.empty()) return std::nullopt;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(rank) - 1];
}

void predict_times(Prediction& prediction, const Nearest& samples) {
  std::array<Duration, 2 * History::kNeighbours> room;
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].late) room[count++] = 2 * samples[i].took;
    if (samples[i].accepted) room[count++] = samples[i].took;
  }
  const std::span times(room.data(), count);
  std::sort(times.begin(), times.end());
  prediction.median = quantile(times, 0.5);
  prediction.p95 = quantile(times, 0.95);
}

void predict_results(Prediction& prediction, const Nearest& samples) {
  double accepted = 0, measured = 0, quality = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    accepted += samples[i].accepted ? 1 : 0;
    measured += samples[i].quality ? 1 : 0;
    quality += samples[i].quality.value_or(0);
  }
  prediction.reliability = (accepted + 1) / static_cast<double>(samples.size() + 1);
  if (measured > 0) prediction.quality = quality / measured;
}

}  // namespace

std::optional<Prediction> History::predict(std::string_view interface, std::string_view csp,
                                           const Features& features) const {
  const auto found = records_.find(ByCsp::View(interface, csp));
  if (found == records_.end() || found->second.samples.empty()) return std::nullopt;
  const Record& record = found->second;
  if (!record.predicted || record.predicted->first != features)
    record.predicted = {features, predict(record.samples, features)};
  Prediction prediction = record.predicted->second;
  prediction.idle = decisions(interface).made - record.samples.back().decision;
  return prediction;
}

Prediction History::predict(const std::deque<Sample>& samples, const Features& features) {
  const Nearest near = nearest(samples, features);
  Prediction prediction;
  prediction.samples = near.size();
  predict_times(prediction, near);
  predict_results(prediction, near);
  return prediction;
}

void History::note_surprise(Record& record, const Prediction& before, const Sample& sample) {
  if (!before.median || !(sample.accepted || sample.late)) return;
  const double ratio = static_cast<double>(std::max(sample.took, kShortest).count()) /
                       static_cast<double>(std::max(*before.median, kShortest).count());
  if (ratio > kSurprise) {
    record.surprises = std::max(record.surprises, 0) + 1;
  } else if (ratio < 1 / kSurprise && !sample.late) {
    record.surprises = std::min(record.surprises, 0) - 1;
  } else {
    record.surprises = 0;
  }
}

void History::add(std::string_view interface, std::string_view csp, Sample sample) {
  auto found = records_.find(ByCsp::View(interface, csp));
  if (found == records_.end()) {
    found = records_.try_emplace({std::string(interface), std::string(csp)}).first;
  } else if (const auto before = predict(interface, csp, sample.features)) {
    note_surprise(found->second, *before, sample);
  }
  Record& record = found->second;
  record.predicted.reset();
  sample.decision = decisions(interface).made;
  record.samples.push_back(std::move(sample));
  if (static_cast<std::size_t>(std::abs(record.surprises)) >= kSurprises) {
    while (record.samples.size() > kSurprises) record.samples.pop_front();
    record.surprises = 0;
  }
  if (record.samples.size() > kKept) record.samples.pop_front();
}

void History::count(std::string_view interface, bool explored) {
  auto found = decisions_.find(interface);
  if (found == decisions_.end()) found = decisions_.try_emplace(std::string(interface)).first;
  ++found->second.made;
  found->second.explored += explored ? 1 : 0;
}

History::Decisions History::decisions(std::string_view interface) const {
  const auto found = decisions_.find(interface);
  return found == decisions_.end() ? Decisions() : found->second;
}

}  // namespace skein
