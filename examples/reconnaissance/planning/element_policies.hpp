#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace reconnaissance {

/// An element of interest, and what is known of it.
struct Element {
  double priority = 1;        ///< Positive; twice as much is twice as important.
  double size_m = 5;          ///< Smaller side of what shall be identified.
  double wanted_gsd_m = 0.3;  ///< Ground sample distance that the order asks for.
  double wanted_deviation_m = 20;
  double deviation_m = 0;  ///< Of the place on each axis, when it was last seen or reported.
  double drift_m_s = 0;    ///< Growth of the deviation since then; 0 for what does not move.
  double known_s = 0;      ///< When that was, in mission time.
  double best_gsd_m = std::numeric_limits<double>::infinity();  ///< Achieved so far.
};

/// What a look at an element would be like.
struct Look {
  double seconds = 0;        ///< From now until it has been collected.
  double gsd_m = 0.3;        ///< Expected.
  double deviation_m = 5;    ///< Of the place afterwards.
  double half_view_m = 100;  ///< Half the width of the camera's footprint.
};

/// √(deviation² + (drift · age)²).
double deviation_m(const Element& element, double now_s);

/// Of identification with that many samples across the target, P = rᴱ / (1 + rᴱ) with r = N / N50
/// and E = 2.7 + 0.7 r (target transfer probability function of the Night Vision Laboratory,
/// Ratches 1976). N cycles are on the target, of two samples each; N50 = 6.4 on the smaller side
/// identify it in half of all cases (Johnson 1958).
double identification_probability(double size_m, double gsd_m);

/// That a place with that deviation on each axis is within a radius: 1 − exp(−r² / 2σ²) (Rayleigh).
double inside_probability(double deviation_m, double radius_m);

/// Has the resolution that was asked for, and is still where it is said to be.
bool is_fulfilled(const Element& element, double now_s);

/// That the element is known as it shall be: identified, and within twice the wanted deviation.
double known_probability(const Element& element, double now_s);

/// What an expected look adds to priority · known_probability() at the time of the look (value of
/// information, Howard 1966). Finds the element if it is inside the footprint.
double value_of_look(const Element& element, const Look& look, double now_s);

// Which element next: an index, or nothing if none is worth a look. `looks` has one for each
// element, nothing for those that cannot be reached. Two policies for the EOI Manager's choice.

/// The most important that is not fulfilled; of equals the soonest.
std::optional<std::size_t> next_by_priority(const std::vector<Element>& elements,
                                            const std::vector<std::optional<Look>>& looks,
                                            double now_s);

/// The greatest value of the look for each second that it takes.
std::optional<std::size_t> next_by_value(const std::vector<Element>& elements,
                                         const std::vector<std::optional<Look>>& looks,
                                         double now_s);

}  // namespace reconnaissance
