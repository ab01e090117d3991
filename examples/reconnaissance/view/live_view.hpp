#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/record.hpp"

namespace reconnaissance {

/// How one of the thirteen says it is.
struct MemberState {
  std::string name;
  std::string condition;  ///< `fine`, or what is wrong in a word.
};

/// A frame of at most so many lines of at most so many columns, in ASCII alone: what is flown, a
/// map, how everybody is, and what was noticed and decided last. 60 columns and 12 lines at least;
/// fewer are taken for these.
std::vector<std::string> live_view(const MissionRecord& record,
                                   const std::vector<MemberState>& members, std::size_t columns,
                                   std::size_t lines);

/// The minutes and seconds of a mission's time.
std::string clock_text(double seconds);

}  // namespace reconnaissance
