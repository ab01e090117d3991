#include "threats/emitter_classification.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace reconnaissance {
namespace {

constexpr double kUnknownPrior = 0.01;

// All that the receiver can measure, for emitters that no class describes.
const EmitterClass kUnknown{"", RadarMode::Off, {0.5e9, 40e9}, {1e-6, 1e-2}, {0, 20}, 0};

/// Measured values with their errors.
struct Measured {
  Waveform values;
  Waveform sigmas;
};

Measured measured(const Waveform& values, const WarnerReceiver& receiver, double count) {
  const double share = 1 / std::sqrt(count);
  return {values,
          {receiver.radio_frequency_sigma_hz * share,
           receiver.pulse_interval_sigma_share * values.pulse_interval_s * share,
           receiver.scan_sigma_s * share}};
}

/// The density of a value uniform in an interval with a normal error.
double density(double value, double sigma, const Interval& interval) {
  const double width = interval.greatest - interval.least;
  const auto below = [&](double bound) {
    return 0.5 * std::erfc((bound - value) / (sigma * std::numbers::sqrt2));
  };
  if (width > 1e-6 * sigma) return (below(interval.least) - below(interval.greatest)) / width;
  const double deviation = (value - interval.least) / sigma;
  return std::exp(-0.5 * deviation * deviation) / (sigma * std::sqrt(2 * std::numbers::pi));
}

double likelihood(const Measured& m, const EmitterClass& emitter) {
  return density(m.values.radio_frequency_hz, m.sigmas.radio_frequency_hz,
                 emitter.radio_frequency_hz) *
         density(m.values.pulse_interval_s, m.sigmas.pulse_interval_s, emitter.pulse_interval_s) *
         density(m.values.scan_s, m.sigmas.scan_s, emitter.scan_s);
}

Identification by_bayes(const Measured& m, std::span<const EmitterClass> library) {
  const double priors =
      std::accumulate(library.begin(), library.end(), 0.0,
                      [](double sum, const EmitterClass& emitter) { return sum + emitter.prior; });
  Identification best;
  double sum = 0;
  const auto consider = [&](const EmitterClass& emitter, double prior) {
    const double probability = prior * likelihood(m, emitter);
    sum += probability;
    if (probability > best.confidence) best = {emitter.type, emitter.mode, probability};
  };
  for (const EmitterClass& emitter : library)
    consider(emitter, (1 - kUnknownPrior) * emitter.prior / priors);
  consider(kUnknown, kUnknownPrior);
  // So far from everything that no density is left.
  if (!(sum > 0)) return {"", RadarMode::Off, 1};
  best.confidence /= sum;
  return best;
}

bool fits(const Measured& m, const EmitterClass& emitter) {
  const auto near = [](double value, double sigma, const Interval& interval) {
    return value > interval.least - 3 * sigma && value < interval.greatest + 3 * sigma;
  };
  return near(m.values.radio_frequency_hz, m.sigmas.radio_frequency_hz,
              emitter.radio_frequency_hz) &&
         near(m.values.pulse_interval_s, m.sigmas.pulse_interval_s, emitter.pulse_interval_s) &&
         near(m.values.scan_s, m.sigmas.scan_s, emitter.scan_s);
}

/// Whether values spread as their errors do: a sum of squares of n - 1 degrees of freedom within
/// five standard deviations of its mean.
bool is_one_value(std::span<const Intercept> intercepts, double Waveform::*value, double mean,
                  double sigma) {
  double sum = 0;
  for (const Intercept& intercept : intercepts) {
    sum += std::pow((intercept.waveform.*value - mean) / sigma, 2);
  }
  const double freedom = static_cast<double>(intercepts.size()) - 1;
  return sum < freedom + 5 * std::sqrt(2 * freedom);
}

}  // namespace

std::span<const EmitterType> emitter_types() {
  static const std::vector<EmitterType> kTypes{
      {"short-range site", 5e8, 18000, 8000}, {"medium-range site", 2e9, 30000, 15000},
      {"mobile gun", 1e8, 10000, 3000},       {"coast radar", 1e9, 25000, 0},
      {"air surveillance", 5e9, 60000, 0},
  };
  return kTypes;
}

std::span<const EmitterClass> emitter_library() {
  static const std::vector<EmitterClass> kLibrary{
      {"short-range site", RadarMode::Search, {2.9e9, 3.1e9}, {0.8e-3, 1.2e-3}, {3.5, 4.5}, 3},
      {"short-range site", RadarMode::Track, {8.6e9, 9.0e9}, {180e-6, 220e-6}, {0, 0}, 2},
      {"short-range site", RadarMode::Guidance, {8.9e9, 9.2e9}, {45e-6, 60e-6}, {0, 0}, 1},
      {"medium-range site", RadarMode::Search, {3.0e9, 3.3e9}, {1.1e-3, 1.6e-3}, {4, 6}, 3},
      {"medium-range site", RadarMode::Track, {8.8e9, 9.4e9}, {200e-6, 260e-6}, {0, 0}, 2},
      {"medium-range site", RadarMode::Guidance, {9.1e9, 9.6e9}, {55e-6, 75e-6}, {0, 0}, 1},
      {"mobile gun", RadarMode::Search, {14.0e9, 15.0e9}, {90e-6, 130e-6}, {1.5, 2.5}, 2},
      {"mobile gun", RadarMode::Track, {14.5e9, 15.5e9}, {80e-6, 110e-6}, {0, 0}, 1},
      {"coast radar", RadarMode::Search, {3.0e9, 3.1e9}, {1.0e-3, 1.3e-3}, {2.5, 3.8}, 1},
      {"air surveillance", RadarMode::Search, {1.25e9, 1.35e9}, {2.5e-3, 4e-3}, {9, 12}, 2},
      {"air surveillance", RadarMode::Track, {3.1e9, 3.4e9}, {1.5e-3, 2.2e-3}, {5, 8}, 1},
  };
  return kLibrary;
}

Identification match_table(const Intercept& intercept, const WarnerReceiver& receiver,
                           std::span<const EmitterClass> library) {
  const Measured m = measured(intercept.waveform, receiver, 1);
  const EmitterClass* first = nullptr;
  double matches = 0;
  for (const EmitterClass& emitter : library) {
    if (!fits(m, emitter)) continue;
    matches += 1;
    if (!first || emitter.prior > first->prior) first = &emitter;
  }
  if (!first) return {"", RadarMode::Off, 1};
  return {first->type, first->mode, 1 / matches};
}

Identification classify_bayesian(const Intercept& intercept, const WarnerReceiver& receiver,
                                 std::span<const EmitterClass> library) {
  return by_bayes(measured(intercept.waveform, receiver, 1), library);
}

std::optional<Identification> classify_wideband(std::span<const Intercept> intercepts,
                                                const WarnerReceiver& receiver,
                                                std::span<const EmitterClass> library) {
  if (intercepts.size() < kWidebandIntercepts) return std::nullopt;
  const auto last = intercepts.last(kWidebandIntercepts);
  Waveform mean{0, 0, 0};
  for (double Waveform::*value :
       {&Waveform::radio_frequency_hz, &Waveform::pulse_interval_s, &Waveform::scan_s}) {
    for (const Intercept& intercept : last) mean.*value += intercept.waveform.*value;
    mean.*value /= static_cast<double>(kWidebandIntercepts);
    const Waveform sigmas = measured(mean, receiver, 1).sigmas;
    if (!is_one_value(last, value, mean.*value, sigmas.*value)) return std::nullopt;
  }
  return by_bayes(measured(mean, receiver, static_cast<double>(kWidebandIntercepts)), library);
}

double vote_weight(double confidence, std::size_t classes) {
  const double right = std::min(confidence, 0.99);
  return std::max(0.0, std::log(static_cast<double>(classes - 1) * right / (1 - right)));
}

}  // namespace reconnaissance
