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
  double deviation_m = 0;                                       ///< Of the place on each axis.
  double best_gsd_m = std::numeric_limits<double>::infinity();  ///< Achieved so far.
};

/// What a look at an element would be like.
struct Look {
  double seconds = 0;        ///< From now until it has been collected.
  double gsd_m = 0.3;        ///< Expected.
  double deviation_m = 5;    ///< Of the place afterwards.
  double half_view_m = 100;  ///< Half the width of the camera's footprint.
};

/// That a place with that deviation on each axis is within a radius: 1 − exp(−r² / 2σ²) (Rayleigh).
double inside_probability(double deviation_m, double radius_m);

/// Has the resolution that was asked for, and is where it is said to be.
bool is_fulfilled(const Element& element);

/// That the element is known as it shall be: identified, and within twice the wanted deviation.
double known_probability(const Element& element);

/// What an expected look adds to priority · known_probability() (value of information, Howard
/// 1966). Finds the element if it is inside the footprint.
double value_of_look(const Element& element, const Look& look);

// Which element next: an index, or nothing if none is worth a look. `looks` has one for each
// element, nothing for those that cannot be reached. Two policies for the EOI Manager's choice.

/// The most important that is not fulfilled; of equals the soonest.
std::optional<std::size_t> next_by_priority(const std::vector<Element>& elements,
                                            const std::vector<std::optional<Look>>& looks);

/// The greatest value of the look for each second that it takes.
std::optional<std::size_t> next_by_value(const std::vector<Element>& elements,
                                         const std::vector<std::optional<Look>>& looks);

}  // namespace reconnaissance
