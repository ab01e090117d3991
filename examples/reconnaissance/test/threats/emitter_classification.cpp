#include "threats/emitter_classification.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace emitter_classification_test {

using namespace reconnaissance;

namespace {

const WarnerReceiver kReceiver;

/// An emitter of the library, drawn by its prior, with its own values.
struct Drawn {
  const EmitterClass* emitter;
  Waveform waveform;
};

Drawn draw(std::span<const EmitterClass> library, Random& random) {
  double priors = 0;
  for (const EmitterClass& emitter : library) priors += emitter.prior;
  double left = priors * random.uniform();
  const EmitterClass* chosen = &library.back();
  for (const EmitterClass& emitter : library) {
    left -= emitter.prior;
    if (left < 0) {
      chosen = &emitter;
      break;
    }
  }
  const auto within = [&](const Interval& interval) {
    return std::lerp(interval.least, interval.greatest, random.uniform());
  };
  const double radio_frequency_hz = within(chosen->radio_frequency_hz);
  const double pulse_interval_s = within(chosen->pulse_interval_s);
  return {chosen, {radio_frequency_hz, pulse_interval_s, within(chosen->scan_s)}};
}

Intercept measure(const Waveform& waveform, Random& random) {
  const Emission emission{1, 0, {5000, 0, 10}, RadarMode::Search, waveform, 1e9};
  return *receive(
      emission, {0, 0, 500}, kReceiver, [](double, double) { return 0.0; }, random);
}

std::vector<Intercept> burst(const Waveform& waveform, Random& random) {
  std::vector<Intercept> intercepts;
  while (intercepts.size() < kWidebandIntercepts) intercepts.push_back(measure(waveform, random));
  return intercepts;
}

bool is_right(const Identification& found, const Drawn& truth) {
  return found.emitter == truth.emitter->type && found.mode == truth.emitter->mode;
}

}  // namespace

TEST_CASE("Bayes tells two radars apart as often as normal errors allow") {
  // Equal priors, known values d apart with errors of sigma: right by Phi(d / 2 sigma) (Fisher's
  // discriminant; for example Duda, Hart and Stork, Pattern Classification, 2001, 2.8).
  const double apart_hz = 1.5 * kReceiver.radio_frequency_sigma_hz;
  const std::vector<EmitterClass> library{
      {"a", RadarMode::Search, {3e9, 3e9}, {1e-3, 1e-3}, {4, 4}, 1},
      {"b", RadarMode::Search, {3e9 + apart_hz, 3e9 + apart_hz}, {1e-3, 1e-3}, {4, 4}, 1}};
  Random random(11);
  constexpr int kRuns = 20000;
  int right = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Drawn truth = draw(library, random);
    right += is_right(classify_bayesian(measure(truth.waveform, random), kReceiver, library), truth)
                 ? 1
                 : 0;
  }
  const double expected = 0.5 * std::erfc(-0.75 / std::sqrt(2));
  // Four standard errors, and the few that fit neither.
  CHECK(static_cast<double>(right) / kRuns == Approx(expected).margin(0.0119));
}

TEST_CASE(
    "Between two radars that fit equally well the more frequent is as probable as it is frequent") {
  const std::vector<EmitterClass> library{
      {"rare", RadarMode::Search, {3.00e9, 3.00e9}, {1e-3, 1e-3}, {4, 4}, 1},
      {"frequent", RadarMode::Search, {3.02e9, 3.02e9}, {1e-3, 1e-3}, {4, 4}, 3}};
  const Intercept between{0, 0, 0.035, {3.01e9, 1e-3, 4}, 1e-6};
  const auto found = classify_bayesian(between, kReceiver, library);
  CHECK(found.emitter == "frequent");
  CHECK(found.confidence == Approx(0.75).epsilon(1e-4));
}

TEST_CASE("A Bayesian confidence is how often it is right") {
  Random random(12);
  constexpr int kBins = 5;
  int count[kBins] = {};
  double right[kBins] = {};
  double said[kBins] = {};
  for (int run = 0; run < 20000; ++run) {
    const Drawn truth = draw(emitter_library(), random);
    const auto found =
        classify_bayesian(measure(truth.waveform, random), kReceiver, emitter_library());
    const int bin = std::min(kBins - 1, static_cast<int>(found.confidence * kBins));
    ++count[bin];
    right[bin] += is_right(found, truth) ? 1 : 0;
    said[bin] += found.confidence;
  }
  for (int bin = 0; bin < kBins; ++bin) {
    if (count[bin] < 100) continue;
    const double n = count[bin];
    const double mean = said[bin] / n;
    INFO("confidence " << mean << ", right " << right[bin] / n << " of " << n);
    CHECK(right[bin] / n == Approx(mean).margin(4 * std::sqrt(mean * (1 - mean) / n) + 0.01));
  }
}

TEST_CASE("The table is right often, Bayes more often, the wideband receiver most often but late") {
  Random random(13);
  constexpr int kRuns = 5000;
  int table = 0;
  int bayesian = 0;
  int wideband = 0;
  int early_vote = 0;
  int late_vote = 0;
  const auto vote = identification_vote<Identification>(emitter_library().size() + 1);
  for (int run = 0; run < kRuns; ++run) {
    const Drawn truth = draw(emitter_library(), random);
    const auto intercepts = burst(truth.waveform, random);
    const auto right = [&](const Identification& found) { return is_right(found, truth) ? 1 : 0; };
    const auto by_table = match_table(intercepts[0], kReceiver, emitter_library());
    const auto by_bayes = classify_bayesian(intercepts[0], kReceiver, emitter_library());
    const auto late = classify_wideband(intercepts, kReceiver, emitter_library());
    std::vector<skein::Opinion<Identification>> opinions{{"table", by_table}, {"Bayes", by_bayes}};
    table += right(by_table);
    bayesian += right(by_bayes);
    if (const auto found = vote(opinions)) early_vote += right(found->result);
    if (late) {
      wideband += right(*late);
      opinions.push_back({"wideband", *late});
    }
    if (const auto found = vote(opinions)) late_vote += right(found->result);
  }
  INFO("right of " << kRuns << ": table " << table << ", Bayes " << bayesian << ", wideband "
                   << wideband << ", vote of two " << early_vote << ", of three " << late_vote);
  CHECK(table > 0.89 * kRuns);
  CHECK(bayesian > 1.05 * table);
  CHECK(wideband > 1.005 * bayesian);
  // The vote is nearly as good as the best that has answered, without knowing which that is.
  CHECK(early_vote > 0.995 * bayesian);
  CHECK(late_vote > 0.995 * wideband);
}

TEST_CASE("A classifier that is wrong and sure of it does not outvote two that are right") {
  const std::size_t classes = emitter_library().size() + 1;
  const auto vote = identification_vote<Identification>(classes);
  const Identification wrong{"coast radar", RadarMode::Search, 1};
  const Identification right{"mobile gun", RadarMode::Track, 0.9};
  const auto voted = vote({{"wideband", wrong}, {"table", right}, {"Bayes", right}});
  REQUIRE(voted);
  CHECK(voted->result.emitter == "mobile gun");
  CHECK(voted->how == "table, Bayes agree, of 3");
  // Of the same type another mode is another class.
  Identification searching = right;
  searching.mode = RadarMode::Search;
  CHECK(vote({{"wideband", wrong}, {"table", right}, {"Bayes", searching}})->result.emitter ==
        "coast radar");
}

TEST_CASE("Who is not even half sure does not suffice alone, and has no vote if he guesses") {
  const auto vote = identification_vote<Identification>(12);
  const Identification unsure{"mobile gun", RadarMode::Track, 0.4};
  CHECK_FALSE(vote({{"table", unsure}}));
  CHECK(vote({{"table", unsure}, {"Bayes", unsure}}));
  CHECK(vote_weight(1.0 / 12, 12) == Approx(0).margin(1e-12));
  CHECK(vote_weight(0, 12) == 0);
  CHECK(vote_weight(0.5, 2) == 0);
  CHECK(vote_weight(0.9, 2) == Approx(std::log(9)));
}

TEST_CASE("Of an emitter that no library has each says so") {
  Random random(14);
  const Waveform strange{5.5e9, 4e-4, 1};
  const auto intercepts = burst(strange, random);
  for (const Identification& found :
       {match_table(intercepts[0], kReceiver, emitter_library()),
        classify_bayesian(intercepts[0], kReceiver, emitter_library()),
        *classify_wideband(intercepts, kReceiver, emitter_library())}) {
    CHECK(found.emitter.empty());
    CHECK(found.mode == RadarMode::Off);
    CHECK(found.confidence > 0.99);
  }
  // So far away that no density is left.
  Intercept absurd = intercepts[0];
  absurd.waveform.radio_frequency_hz = 1e15;
  CHECK(classify_bayesian(absurd, kReceiver, emitter_library()).confidence == 1);
}

TEST_CASE("Of several matches the table takes the most frequent, and is less sure") {
  Random random(15);
  // Both sites in track: 8.9 GHz, 210 us.
  Intercept intercept = measure({8.9e9, 210e-6, 0}, random);
  intercept.waveform = {8.9e9, 210e-6, 0};
  std::vector<EmitterClass> library(emitter_library().begin(), emitter_library().end());
  CHECK(match_table(intercept, kReceiver, library).confidence == 0.5);
  CHECK(match_table(intercept, kReceiver, library).emitter == "short-range site");
  for (EmitterClass& emitter : library) {
    if (emitter.type == "medium-range site") emitter.prior *= 2;
  }
  CHECK(match_table(intercept, kReceiver, library).emitter == "medium-range site");
}

TEST_CASE("The wideband receiver waits for a burst of one mode") {
  Random random(16);
  auto intercepts = burst({3.05e9, 1e-3, 4}, random);
  REQUIRE(classify_wideband(intercepts, kReceiver, emitter_library()));
  CHECK_FALSE(classify_wideband(std::span(intercepts).first(kWidebandIntercepts - 1), kReceiver,
                                emitter_library()));
  // After the change of its mode it has to be heard as often again.
  const auto tracking = burst({8.7e9, 2e-4, 0}, random);
  for (std::size_t i = 0; i < kWidebandIntercepts; ++i) {
    intercepts.push_back(tracking[i]);
    const auto found = classify_wideband(intercepts, kReceiver, emitter_library());
    CHECK(found.has_value() == (i + 1 == kWidebandIntercepts));
  }
  const auto found = classify_wideband(intercepts, kReceiver, emitter_library());
  REQUIRE(found);
  CHECK(found->emitter == "short-range site");
  CHECK(found->mode == RadarMode::Track);
}

}  // namespace emitter_classification_test
