#include "planning/element_policies.hpp"

#include <algorithm>
#include <cmath>

#include "sensing/target_detection.hpp"

namespace reconnaissance {
namespace {

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

double inside_probability(double deviation_m, double radius_m) {
  if (deviation_m <= 0) return 1;
  const double ratio = radius_m / deviation_m;
  return -std::expm1(-ratio * ratio / 2);
}

bool is_fulfilled(const Element& element) {
  return element.best_gsd_m <= element.wanted_gsd_m &&
         element.deviation_m <= element.wanted_deviation_m;
}

double known_probability(const Element& element) {
  return observer_probability(element.size_m, element.best_gsd_m, kIdentificationPairs) *
         inside_probability(element.deviation_m, 2 * element.wanted_deviation_m);
}

double value_of_look(const Element& element, const Look& look) {
  Element seen = element;
  seen.best_gsd_m = std::min(element.best_gsd_m, look.gsd_m);
  seen.deviation_m = std::min(look.deviation_m, element.deviation_m);
  return element.priority * inside_probability(element.deviation_m, look.half_view_m) *
         (known_probability(seen) - known_probability(element));
}

std::optional<std::size_t> next_by_priority(const std::vector<Element>& elements,
                                            const std::vector<std::optional<Look>>& looks) {
  return greatest(elements, looks,
                  [](const Element& element, const Look&) -> std::optional<double> {
                    if (is_fulfilled(element)) return std::nullopt;
                    return element.priority;
                  });
}

std::optional<std::size_t> next_by_value(const std::vector<Element>& elements,
                                         const std::vector<std::optional<Look>>& looks) {
  return greatest(elements, looks,
                  [](const Element& element, const Look& look) -> std::optional<double> {
                    const double value = value_of_look(element, look);
                    if (value < kLeastValue * element.priority) return std::nullopt;
                    return value / std::max(look.seconds, 1.0);
                  });
}

}  // namespace reconnaissance
