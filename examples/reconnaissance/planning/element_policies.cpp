#include "planning/element_policies.hpp"

#include <algorithm>
#include <cmath>

namespace reconnaissance {
namespace {

constexpr double kCyclesForHalf = 6.4;
// Below this, in units of priority, a look is not worth the flight.
constexpr double kLeastValue = 0.01;

template <class Score>
std::optional<std::size_t> greatest(const std::vector<Element>& elements,
                                    const std::vector<std::optional<Look>>& looks, Score&& score) {
  std::optional<std::size_t> best;
  double most = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!looks[i]) continue;
    const std::optional<double> one = score(elements[i], *looks[i]);
    if (!one) continue;
    const bool sooner = best && *one == most && looks[i]->seconds < looks[*best]->seconds;
    if (best && *one <= most && !sooner) continue;
    best = i;
    most = *one;
  }
  return best;
}

}  // namespace

double deviation_m(const Element& element, double now_s) {
  return std::hypot(element.deviation_m,
                    element.drift_m_s * std::max(now_s - element.known_s, 0.0));
}

double identification_probability(double size_m, double gsd_m) {
  const double ratio = size_m / (2 * gsd_m) / kCyclesForHalf;
  const double power = std::pow(ratio, 2.7 + 0.7 * ratio);
  return std::isinf(power) ? 1 : power / (1 + power);
}

double inside_probability(double deviation_m, double radius_m) {
  if (deviation_m <= 0) return 1;
  const double ratio = radius_m / deviation_m;
  return -std::expm1(-ratio * ratio / 2);
}

bool is_fulfilled(const Element& element, double now_s) {
  return element.best_gsd_m <= element.wanted_gsd_m &&
         deviation_m(element, now_s) <= element.wanted_deviation_m;
}

double known_probability(const Element& element, double now_s) {
  return identification_probability(element.size_m, element.best_gsd_m) *
         inside_probability(deviation_m(element, now_s), 2 * element.wanted_deviation_m);
}

double value_of_look(const Element& element, const Look& look, double now_s) {
  const double then_s = now_s + look.seconds;
  Element seen = element;
  seen.best_gsd_m = std::min(element.best_gsd_m, look.gsd_m);
  seen.deviation_m = std::min(look.deviation_m, deviation_m(element, then_s));
  seen.known_s = then_s;
  const double found = inside_probability(deviation_m(element, then_s), look.half_view_m);
  return element.priority * found *
         (known_probability(seen, then_s) - known_probability(element, then_s));
}

std::optional<std::size_t> next_by_priority(const std::vector<Element>& elements,
                                            const std::vector<std::optional<Look>>& looks,
                                            double now_s) {
  return greatest(elements, looks,
                  [&](const Element& element, const Look&) -> std::optional<double> {
                    if (is_fulfilled(element, now_s)) return std::nullopt;
                    return element.priority;
                  });
}

std::optional<std::size_t> next_by_value(const std::vector<Element>& elements,
                                         const std::vector<std::optional<Look>>& looks,
                                         double now_s) {
  return greatest(elements, looks,
                  [&](const Element& element, const Look& look) -> std::optional<double> {
                    const double value = value_of_look(element, look, now_s);
                    if (value < kLeastValue * element.priority) return std::nullopt;
                    return value / std::max(look.seconds, 1.0);
                  });
}

}  // namespace reconnaissance
