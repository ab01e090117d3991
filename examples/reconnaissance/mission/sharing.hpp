#pragma once

#include <cstddef>
#include <vector>

#include "geodesy/local_frame.hpp"
#include "mission/elements.hpp"

namespace reconnaissance {

/// Shares places out among aircraft: none has more than one place more than another, and the sum of
/// the distances on the map from where each aircraft starts to its places is the least possible.
/// Returns the number of the aircraft for each place. Of shares that are equally good the first
/// places go to the first aircraft, so that all who ask have the same answer. Throws
/// skein::InvalidArgument if there is no aircraft.
std::vector<std::size_t> share_out(const std::vector<Local>& places,
                                   const std::vector<Local>& starts);

/// Of elements that are shared out by their middles: those of the aircraft of that number, from 0.
std::vector<ElementText> share_of(const std::vector<ElementText>& elements,
                                  const std::vector<Geodetic>& starts, std::size_t aircraft);

}  // namespace reconnaissance
