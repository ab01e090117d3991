#include "service_history.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <span>

namespace skein::entity {
namespace {

// Below this a change of threads and the system's load count for more than the CSP.
constexpr Duration kShortest = std::chrono::microseconds(100);
// What a run without a result counts as, in times of what it took: PAR10.
constexpr double kPenalty = 10;
// How much a quality from 0 to 1 matters beside the natural logarithm of a time.
constexpr double kQualityWeight = 2;

// For the cumulative sum: ranks are uniform around 0.5 where nothing has changed.
constexpr double kAllowance = 0.25;
constexpr double kAlarm = 1.7;
constexpr double kLeastRanked = 2;  // by weight

// Of requests with nothing in common.
constexpr double kLeastSimilar = 0.05;

// Lessons come when so many requests have been added, and a share of those that are known.
constexpr std::size_t kLeastLesson = 16;
constexpr std::size_t kLessonShare = 16;

double cost_of(const History::Sample& sample) {
  const auto took = static_cast<double>(std::max(sample.took, kShortest).count());
  return std::log(took * (sample.accepted ? 1 : kPenalty));
}

float bounded(double value) {
  if (std::isnan(value)) return Lessons::kMissing;
  return static_cast<float>(std::clamp(value, -2e38, 2e38));
}

struct Mean {
  double sum = 0;
  double count = 0;
  void add(double value, double weight = 1) {
    sum += weight * value;
    count += weight;
  }
  double value() const { return count > 0 ? sum / count : 0; }
};

/// What a forest is to explain: costs and qualities beside those of other CSPs on the same request,
/// or where one ran alone, beside its own on others.
class Targets {
 public:
  explicit Targets(const std::map<std::uint64_t, Experience::Request>& requests) {
    for (const auto& [number, request] : requests) {
      for (const auto& run : request.runs) {
        if (run.csp >= costs_.size()) costs_.resize(run.csp + 1), qualities_.resize(run.csp + 1);
        costs_[run.csp].add(cost_of(run.sample));
        if (run.sample.quality) qualities_[run.csp].add(*run.sample.quality);
      }
    }
  }

  std::size_t outputs() const { return 2 * costs_.size(); }

  void append(const Experience::Request& request, Lessons& lessons) const {
    Mean cost, quality;
    for (const auto& run : request.runs) {
      cost.add(cost_of(run.sample));
      if (run.sample.quality) quality.add(*run.sample.quality);
    }
    for (const auto& run : request.runs) {
      const Mean& usual_cost = cost.count > 1 ? cost : costs_[run.csp];
      lessons.targets.push_back(
          {2 * run.csp, static_cast<float>(cost_of(run.sample) - usual_cost.value())});
      if (!run.sample.quality) continue;
      const Mean& usual = quality.count > 1 ? quality : qualities_[run.csp];
      lessons.targets.push_back(
          {2 * run.csp + 1,
           static_cast<float>(kQualityWeight * (*run.sample.quality - usual.value()))});
    }
    lessons.first.push_back(static_cast<std::uint32_t>(lessons.targets.size()));
  }

 private:
  std::vector<Mean> costs_, qualities_;
};

/// Times with their weights.
using Times = std::vector<std::pair<Duration, double>>;

// By nearest rank.
std::optional<Duration> quantile(const Times& sorted, double share) {
  double all = 0;
  for (const auto& [time, weight] : sorted) all += weight;
  double until = 0;
  for (const auto& [time, weight] : sorted) {
    until += weight;
    if (until >= share * all * (1 - 1e-9)) return time;
  }
  return std::nullopt;
}

void predict_times(Prediction& prediction) {
  Times times;
  times.reserve(prediction.runs.size());
  for (const SimilarRun& run : prediction.runs) {
    if (run.weight > 0 && (run.accepted || run.late))
      times.emplace_back(run.accepted ? run.took : 2 * run.took, run.weight);
  }
  std::sort(times.begin(), times.end());
  prediction.median = quantile(times, 0.5);
  prediction.p95 = quantile(times, 0.95);
}

void predict_results(Prediction& prediction) {
  double accepted = 0, all = 0;
  Mean quality;
  for (const SimilarRun& run : prediction.runs) {
    if (run.weight == 0) continue;
    all += 1;
    accepted += run.accepted ? 1 : 0;
    prediction.similar += run.weight >= kSimilar ? 1 : 0;
    if (run.quality) quality.add(*run.quality, run.weight);
  }
  prediction.reliability = (accepted + 1) / (all + 1);
  if (quality.count > 0) prediction.quality = quality.value();
}

// The share of the predicted runs that were faster; of a run that was given up, the middle of what
// it may be.
std::optional<double> rank_of(const History::Sample& sample, const Prediction& predicted) {
  double faster = 0, timed = 0;
  for (const SimilarRun& run : predicted.runs) {
    if (!run.accepted && !run.late) continue;
    timed += run.weight;
    faster += run.took < sample.took ? run.weight : run.took == sample.took ? run.weight / 2 : 0;
  }
  if (timed < kLeastRanked) return std::nullopt;
  const double rank = faster / timed;
  return sample.late ? (rank + 1) / 2 : rank;
}

// Of thousands of runs hardly one is in the processor's cache: all are asked for before the first
// is needed.
void prefetch(const Experience::Run& run) {
  const char* const begin = reinterpret_cast<const char*>(&run);
  __builtin_prefetch(begin);
  __builtin_prefetch(begin + sizeof(run) - 1);
}

void add_to(double& sum, std::uint64_t& since, double excess, std::uint64_t request) {
  sum += excess - kAllowance;
  if (sum > 0 && since != 0) return;
  sum = std::max(sum, 0.0);
  since = sum > 0 ? request : 0;
}

// Page's test (1954) on ranks. The first request after the change, once that is sure.
std::optional<std::uint64_t> change(ServiceHistory::Drift& drift, double rank,
                                    std::uint64_t request) {
  add_to(drift.slower, drift.slower_since, rank - 0.5, request);
  add_to(drift.faster, drift.faster_since, 0.5 - rank, request);
  if (std::max(drift.slower, drift.faster) < kAlarm) return std::nullopt;
  return drift.slower > drift.faster ? drift.slower_since : drift.faster_since;
}

}  // namespace

void Experience::Request::add(Run run) {
  for (Run& known : runs) {
    if (known.csp != run.csp) continue;
    known = std::move(run);
    return;
  }
  runs.push_back(std::move(run));
}

Experience::Experience(std::vector<Run> runs) {
  std::map<std::uint64_t, Request> by_number;
  for (Run& run : runs) {
    Request& request = by_number[run.sample.request];
    request.add(std::move(run));
  }
  for (const auto& [number, request] : by_number) {
    for (const Feature& feature : request.features()) {
      if (std::find(columns_.begin(), columns_.end(), feature.name) == columns_.end())
        columns_.push_back(feature.name);
    }
  }
  Lessons lessons;
  lessons.columns = columns_.size();
  const Targets targets(by_number);
  lessons.outputs = targets.outputs();
  for (auto& [number, request] : by_number) {
    const auto row = row_of(request.features());
    lessons.features.insert(lessons.features.end(), row.begin(), row.end());
    targets.append(request, lessons);
    std::move(request.runs.begin(), request.runs.end(), std::back_inserter(runs_));
    first_.push_back(static_cast<std::uint32_t>(runs_.size()));
  }
  forest_ = Forest(lessons);
}

std::vector<float> Experience::row_of(const Features& features) const {
  std::vector<float> row(columns_.size(), Lessons::kMissing);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const bool in_place = i < columns_.size() && columns_[i] == features[i].name;
    const auto column = in_place ? columns_.begin() + static_cast<std::ptrdiff_t>(i)
                                 : std::find(columns_.begin(), columns_.end(), features[i].name);
    if (column == columns_.end()) continue;
    row[static_cast<std::size_t>(column - columns_.begin())] = bounded(features[i].value);
  }
  return row;
}

Forest::Leaves Experience::leaves(const Features& features) const {
  return forest_.leaves(row_of(features));
}

std::vector<Experience::Similar> Experience::similar(const Features& features,
                                                     const std::vector<Request>& added) const {
  const Forest::Leaves leaves = this->leaves(features);
  std::vector<Similar> found;
  for (auto request = added.rbegin(); request != added.rend(); ++request) {
    std::size_t trees = 0;
    for (std::size_t i = 0; i < Forest::kTrees; ++i) trees += leaves[i] == request->leaves[i];
    if (trees > 0) found.push_back({request->runs, trees});
  }
  std::vector<std::uint8_t> trees(size());
  std::vector<std::uint32_t> rows;
  forest_.prefetch(leaves);
  for (const std::uint32_t leaf : leaves) {
    for (const std::uint32_t row : forest_.rows(leaf)) {
      if (trees[row]++ == 0) rows.push_back(row);
    }
  }
  found.reserve(found.size() + rows.size());
  for (const std::uint32_t row : rows) {
    const auto runs = runs_of(row);
    prefetch(runs.front());
    found.push_back({runs, trees[row]});
  }
  // A counting sort: there are few numbers of trees.
  std::array<std::size_t, Forest::kTrees + 2> place{};
  for (const Similar& each : found) ++place[Forest::kTrees - each.trees + 1];
  for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
  std::vector<Similar> sorted(found.size());
  for (const Similar& each : found) sorted[place[Forest::kTrees - each.trees]++] = each;
  return sorted;
}

std::optional<std::uint32_t> ServiceHistory::index_of(std::string_view csp) const {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    if (records_[i].csp == csp) return static_cast<std::uint32_t>(i);
  }
  return std::nullopt;
}

void ServiceHistory::add(std::string_view csp, History::Sample sample,
                         const Prediction* predicted) {
  auto index = index_of(csp);
  if (!index) {
    index = static_cast<std::uint32_t>(records_.size());
    records_.push_back({std::string(csp), {}, {}});
  }
  Record& record = records_[*index];
  if (predicted && (sample.accepted || sample.late)) {
    const auto rank = rank_of(sample, *predicted);
    if (const auto since = rank ? change(record.drift, *rank, sample.request) : std::nullopt) {
      std::erase_if(record.samples, [&](const auto& past) { return past.request < *since; });
      record.drift = {};
    }
  }
  remember(*index, sample);
  record.samples.push_back(std::move(sample));
  if (record.samples.size() > History::kKept) record.samples.pop_front();
}

void ServiceHistory::restore(Record record) {
  const auto index = static_cast<std::uint32_t>(records_.size());
  for (const History::Sample& sample : record.samples) remember(index, sample);
  records_.push_back(std::move(record));
}

void ServiceHistory::remember(std::uint32_t csp, const History::Sample& sample) {
  if (reached_.size() <= sample.after) reached_.resize(sample.after + 1);
  ++reached_[sample.after];
  Experience::Run run{csp, ++version_, sample};
  for (auto request = added_.rbegin(); request != added_.rend(); ++request) {
    if (request->number() == sample.request) return request->add(std::move(run));
    if (request->number() < sample.request) break;
  }
  added_.push_back({{std::move(run)}, learned_->leaves(*sample.features)});
}

std::vector<std::optional<Prediction>> ServiceHistory::predict(
    const std::vector<std::string_view>& csps, const Features& features) const {
  asked_ = true;
  std::vector<std::optional<Prediction>> predictions(csps.size());
  std::vector<Prediction*> wanted(records_.size());
  std::vector<std::size_t> counted(records_.size());
  std::size_t open = 0;
  for (std::size_t i = 0; i < csps.size(); ++i) {
    const auto index = index_of(csps[i]);
    if (!index || records_[*index].samples.empty()) continue;
    wanted[*index] = &predictions[i].emplace();
    wanted[*index]->runs.reserve(History::kNeighbours);
    ++open;
  }
  const auto is_kept = [&](const Experience::Run& run) {
    return wanted[run.csp] && run.sample.request >= records_[run.csp].samples.front().request;
  };
  for (const auto& [runs, trees] : learned_->similar(features, added_)) {
    if (open == 0) break;
    const bool counts = std::any_of(runs.begin(), runs.end(), [&](const auto& run) {
      return is_kept(run) && counted[run.csp] < History::kNeighbours;
    });
    if (!counts) continue;
    for (const auto& run : runs) {
      if (!is_kept(run) || wanted[run.csp]->runs.size() == History::kListed) continue;
      const bool full = counted[run.csp] == History::kNeighbours;
      const double similarity = full ? 0 : static_cast<double>(trees) / Forest::kTrees;
      wanted[run.csp]->runs.push_back(similar_run(run.sample, similarity));
      if (!full && ++counted[run.csp] == History::kNeighbours) --open;
    }
  }
  for (std::size_t i = 0; i < records_.size(); ++i) {
    if (!wanted[i]) continue;
    Prediction& prediction = *wanted[i];
    fill_up(prediction, History::kNeighbours - counted[i], records_[i]);
    predict_times(prediction);
    predict_results(prediction);
    prediction.idle = decisions.made - std::min(decisions.made, records_[i].samples.back().request);
  }
  return predictions;
}

SimilarRun ServiceHistory::similar_run(const History::Sample& sample, double similarity) const {
  const double reached = (reached_[sample.after] + 1) / (reached_[0] + 1);
  return {sample.request, similarity * std::min(reached, 1.0),
          sample.took,    sample.accepted,
          sample.late,    sample.quality};
}

// With the latest of those that have nothing in common with the request.
void ServiceHistory::fill_up(Prediction& prediction, std::size_t missing,
                             const Record& record) const {
  const std::size_t similar = prediction.runs.size();
  for (auto past = record.samples.rbegin(); past != record.samples.rend() && missing > 0; ++past) {
    if (prediction.runs.size() == History::kListed) break;
    const auto known = prediction.runs.begin() + static_cast<std::ptrdiff_t>(similar);
    if (std::any_of(prediction.runs.begin(), known,
                    [&](const SimilarRun& run) { return run.request == past->request; }))
      continue;
    prediction.runs.push_back(similar_run(*past, kLeastSimilar));
    --missing;
  }
}

bool ServiceHistory::is_due() const {
  return asked_ && added_.size() >= std::max(kLeastLesson, learned_->size() / kLessonShare);
}

std::vector<Experience::Run> ServiceHistory::runs() const {
  asked_ = false;
  std::vector<Experience::Run> runs;
  for (std::uint32_t csp = 0; csp < records_.size(); ++csp) {
    for (const auto& sample : records_[csp].samples) runs.push_back({csp, 0, sample});
  }
  return runs;
}

void ServiceHistory::take(std::shared_ptr<const Experience>& learned, std::uint64_t version) {
  learned_.swap(learned);
  for (Experience::Request& request : added_)
    std::erase_if(request.runs, [&](const auto& run) { return run.version <= version; });
  std::erase_if(added_, [](const Experience::Request& request) { return request.runs.empty(); });
  for (Experience::Request& request : added_) request.leaves = learned_->leaves(request.features());
}

}  // namespace skein::entity
