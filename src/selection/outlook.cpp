#include "outlook.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace skein::entity {
namespace {

// A missed deadline beside an answer at the last moment, as fields score it (PAR10) and twice.
constexpr double kMiss = 20;
constexpr double kQuality = 10;
// Beside a run on an equal request: the weight of what is assumed without any run, and of what is
// assumed by all similar runs where a request is known to be like some of them only.
constexpr double kPrior = 0.25;
constexpr double kUsual = 1;
// Chance of a CSP that has not run: within what it declares, and before.
constexpr double kKeepsWord = 0.8;
constexpr double kBeforeWord = 0.1;
constexpr double kUnknown = 0.5;
constexpr float kNever = std::numeric_limits<float>::infinity();
// Chance that a CSP that was stopped would have answered, had it had ever so long.
constexpr float kLater = 0.95f;

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

Cases::Cases(std::size_t runs) : slots_(std::bit_ceil(2 * runs + 2), {0, 0}) {}

std::uint32_t Cases::index_of(std::uint64_t request) {
  const std::size_t mask = slots_.size() - 1;
  const std::uint64_t key = request + 1;  // 0 is an empty slot
  for (std::size_t slot = (key * 0x9e3779b97f4a7c15u >> 32) & mask;; slot = (slot + 1) & mask) {
    if (slots_[slot].first == key) return slots_[slot].second;
    if (slots_[slot].first != 0) continue;
    slots_[slot] = {key, count_};
    return count_++;
  }
}

Losses::Losses(const Situation& situation, std::span<const Candidate> candidates) {
  const double whole = std::max(seconds(situation.remaining), 1e-9);
  miss = kMiss;
  per_second = 1 / whole;
  if (situation.utility.aim == Utility::Aim::GoodEnoughSoon) {
    poor = kMiss / 2;
    good_enough = situation.utility.good_enough;
  }
  if (situation.utility.aim != Utility::Aim::BestByDeadline) return;
  for (const Candidate& candidate : candidates) {
    double quality = candidate.quality;
    if (candidate.learned) quality = candidate.learned->quality.value_or(quality);
    best_quality = std::max(best_quality, quality);
  }
  if (best_quality > 0) per_quality = kQuality / best_quality;
}

double Losses::of_quality(double quality) const {
  return per_quality * std::max(0.0, best_quality - quality) + (quality < good_enough ? poor : 0);
}

Outlook::Outlook(const Candidate& candidate, const Losses& losses, Cases& cases) {
  declared_ = candidate.latency ? seconds(*candidate.latency) : 0;
  double quality = candidate.quality;
  if (candidate.learned) {
    quality = candidate.learned->quality.value_or(quality);
    for (const SimilarRun& run : candidate.learned->runs) {
      if (count_ == runs_.size()) break;
      const auto took = static_cast<float>(seconds(run.took));
      float answer = kNever;
      if (run.accepted) answer = took;
      runs_[count_++] = {took,
                         answer,
                         static_cast<float>(run.weight),
                         static_cast<float>(losses.of_quality(run.quality.value_or(quality))),
                         cases.index_of(run.request),
                         run.late};
    }
    // Apart, so that the loops over either are without branches.
    const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto late = std::partition(runs_.begin(), end, [](const Run& run) { return !run.late; });
    first_late_ = static_cast<std::size_t>(late - runs_.begin());
  }
  declared_loss_ = losses.of_quality(quality);
  rank();
}

void Outlook::rank() {
  longest_ = 0;
  for (std::size_t i = 0; i < first_late_; ++i) {
    if (runs_[i].answer < kNever && runs_[i].weight > 0)
      longest_ = std::max<double>(longest_, runs_[i].took);
  }
  if (longest_ == 0) longest_ = declared_;
  for (std::size_t i = first_late_; i < count_; ++i) {
    const float took = runs_[i].took;
    int beyond = 0, before = 0;
    for (std::size_t k = 0; k < first_late_; ++k) {
      before += runs_[k].answer <= took;
      const int later = runs_[k].answer > took, ever = runs_[k].answer < kNever;
      beyond += later & ever;
    }
    for (std::size_t k = first_late_; k < count_; ++k) beyond += runs_[k].took > took;
    runs_[i].before = static_cast<float>(before);
    runs_[i].share = 1 / (1 + static_cast<float>(beyond));
  }
}

double Outlook::typical() const {
  std::array<float, History::kListed> times;
  std::size_t answers = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (runs_[i].answer < kNever && runs_[i].weight > 0) times[answers++] = runs_[i].took;
  }
  if (answers == 0) return declared_;
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(answers / 2);
  std::nth_element(times.begin(), middle, times.begin() + static_cast<std::ptrdiff_t>(answers));
  return *middle;
}

/// Whether runs would have answered within a slice.
class Outlook::Answers {
 public:
  Answers(const Outlook& outlook, float slice)
      : slice_(slice), per_slice_(slice > 0 ? kLater / slice : 0) {
    if (outlook.first_late_ == outlook.count_) return;
    for (std::size_t i = 0; i < outlook.first_late_; ++i)
      by_then_ += static_cast<float>(outlook.runs_[i].answer <= slice);
  }

  float of(const Run& run) const { return static_cast<float>(run.answer <= slice_); }

  // Where that is not known, since it was stopped before: as those runs that went on (Kaplan and
  // Meier 1958), and one that may be anything.
  float of_late(const Run& run) const {
    const float went_on = static_cast<float>(run.took < slice_);
    const float later = kLater - per_slice_ * run.took;
    return went_on * (later + by_then_ - run.before) * run.share;
  }

 private:
  float slice_;
  float per_slice_;
  float by_then_ = 0;
};

double Outlook::prior(double slice) const {
  if (declared_ == 0) return kUnknown;
  return slice >= declared_ ? kKeepsWord : kBeforeWord;
}

Outlook::Chance Outlook::within(double slice, const Losses& losses,
                                const Cases::Weights& weights) const {
  const auto limit = static_cast<float>(slice);
  const Answers answers(*this, limit);
  float usual = 0, usual_of = 0, now = 0, now_of = 0, took = 0, quality_loss = 0;
  const auto add = [&](const Run& run, float answer) {
    const float answered = run.weight * answer;
    const float weight = weights[run.request];
    const float answered_now = weight * answered;
    usual += answered;
    usual_of += run.weight;
    now += answered_now;
    now_of += weight * run.weight;
    took += answered_now * std::min(run.took, limit);
    quality_loss += answered_now * run.quality_loss;
  };
  for (std::size_t i = 0; i < first_late_; ++i) add(runs_[i], answers.of(runs_[i]));
  for (std::size_t i = first_late_; i < count_; ++i) add(runs_[i], answers.of_late(runs_[i]));
  const double assumed = (usual + kPrior * prior(slice)) / (usual_of + kPrior);
  const double all = now_of + kUsual;
  const double assumed_took = longest_ > 0 ? std::min(longest_, slice) : slice / 2;
  const double by_time = (took + kUsual * assumed * assumed_took) / all;
  const double by_quality = (quality_loss + kUsual * assumed * declared_loss_) / all;
  return {(now + kUsual * assumed) / all, by_time * losses.per_second + by_quality};
}

Cases::Weights Outlook::after_failing(double slice, double answers,
                                      const Cases::Weights& weights) const {
  Cases::Weights after = weights;
  for (float& weight : after) weight *= static_cast<float>(1 - answers);
  const Answers known(*this, static_cast<float>(slice));
  for (std::size_t i = 0; i < count_; ++i) {
    const Run& run = runs_[i];
    const float answer = i < first_late_ ? known.of(run) : known.of_late(run);
    after[run.request] = weights[run.request] * (1 - answer);
  }
  return after;
}

Outlook::Count Outlook::count(double slice, const Cases::Weights& weights) const {
  const auto similar = [](const Run& run) { return run.weight >= static_cast<float>(kSimilar); };
  float most = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (similar(runs_[i])) most = std::max(most, weights[runs_[i].request]);
  }
  Count count;
  for (std::size_t i = 0; i < count_; ++i) {
    const float weight = weights[runs_[i].request];
    if (!similar(runs_[i]) || weight == 0 || weight < most / 2) continue;
    ++count.known;
    count.answered += runs_[i].answer <= static_cast<float>(slice);
  }
  return count;
}

}  // namespace skein::entity
