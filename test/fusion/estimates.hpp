#pragma once

#include <catch2/catch.hpp>

#include "skein/fusion.hpp"

namespace skein::fusion {

/// The published example of two tracks that are sure of opposite diagonals.
inline const Estimate kRising{{1, 2, 0}, {10, 5, 0, 5, 10, 0, 0, 0, 1}};
inline const Estimate kFalling{{2, 2, 0}, {10, -5, 0, -5, 10, 0, 0, 0, 1}};

inline void check_near(const std::vector<double>& values, const std::vector<double>& expected,
                       double margin = 1e-6) {
  REQUIRE(values.size() == expected.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    CHECK(values[i] == Approx(expected[i]).margin(margin));
}

}  // namespace skein::fusion
