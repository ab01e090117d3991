#pragma once

#include <optional>
#include <span>
#include <string>

#include "skein/evaluation.hpp"
#include "threats/warner_receiver.hpp"

// Three ways to tell from measured waveforms which radar transmits, and in which mode. Each is a
// pure function: the body of a CSP. identification_vote() is the Head's synthesis of their results.
namespace reconnaissance {

/// A type of radar in one of its modes, as a warner's library has it. Each radar of the type has
/// one value of each interval, whose ends are equal if it is exactly known.
struct EmitterClass {
  std::string type;
  RadarMode mode;
  Interval radio_frequency_hz;
  Interval pulse_interval_s;
  Interval scan_s;
  double prior;  ///< How often it is met, against the other classes; positive.
};

/// What is known of a type from elsewhere.
struct EmitterType {
  std::string name;
  double radiated_power_w;  ///< Effective: with the antenna's gain.
  double detection_m;       ///< From where on it sees a small aircraft.
  double lethal_m;          ///< How far its weapon reaches; 0 without one.
};

/// Five invented types, in frequency bands that such radars use: two missile sites, a gun, two
/// surveillance radars.
std::span<const EmitterType> emitter_types();

/// The modes of emitter_types() in 11 classes. Some cannot be told apart by one measurement.
std::span<const EmitterClass> emitter_library();

struct Identification {
  std::string emitter;  ///< The type; empty: none of the library.
  RadarMode mode = RadarMode::Off;
  double confidence = 0;  ///< The probability that type and mode are right.
};

/// The first look of most warners: the classes of which no measured value is further than three
/// standard deviations outside. The most frequent of them, with a confidence of 1 by their number.
/// It knows neither how well a value fits nor what is rare.
Identification match_table(const Intercept& intercept, const WarnerReceiver& receiver,
                           std::span<const EmitterClass> library);

/// The class with the greatest posterior probability by Bayes' rule. Values are uniform in their
/// intervals, errors normal; "none of them" is uniform over all that the receiver can measure, with
/// a prior of 1 in 100.
Identification classify_bayesian(const Intercept& intercept, const WarnerReceiver& receiver,
                                 std::span<const EmitterClass> library);

/// So many intercepts classify_wideband() waits for: 8 s of a radar in search, 1.6 s in guidance.
inline constexpr std::size_t kWidebandIntercepts = 16;

/// As classify_bayesian(), with the errors of a mean: of the last kWidebandIntercepts of one
/// emitter, in order of time. Better, but later. nullopt if there are fewer yet, or if they differ
/// by more than their errors explain (the mode has changed among them).
std::optional<Identification> classify_wideband(std::span<const Intercept> intercepts,
                                                const WarnerReceiver& receiver,
                                                std::span<const EmitterClass> library);

/// What an opinion counts: the log odds that it is right, ln((k − 1) p / (1 − p)) of k classes, at
/// least 0 (Nitzan and Paroush, "Optimal decision rules in uncertain dichotomous choice
/// situations", International Economic Review 23(2), 1982; for more than two classes Zhu and
/// others, "Multi-class AdaBoost", Statistics and Its Interface 2, 2009). Confidences above 0.99
/// count as 0.99, so that two classifiers that are sure outvote a third that is wrong.
double vote_weight(double confidence, std::size_t classes);

/// The Head's synthesis: the type and mode with the greatest sum of weights. It is not sufficient
/// if that is less than one opinion with a confidence of one half. Result has the members emitter,
/// mode and confidence, as Identification does; `classes` counts "none of them", too.
template <class Result>
skein::Synthesis<Result> identification_vote(std::size_t classes) {
  return skein::weighted_vote<Result>(
      [classes](const skein::Opinion<Result>& opinion) {
        return vote_weight(opinion.result.confidence, classes);
      },
      vote_weight(0.5, classes),
      [](const Result& a, const Result& b) { return a.emitter == b.emitter && a.mode == b.mode; });
}

}  // namespace reconnaissance
