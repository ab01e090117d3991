#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// An emitter that is to be placed: it was reported there, and may be so far from it.
struct ReportedEmitter {
  Local place{};
  double margin_m = 0;
};

/// An emitter that was heard, with the deviation of its place in the worst direction.
struct HeardEmitter {
  Local place{};
  double deviation_m = 0;
};

/// Which of those that were heard is which of those that were reported.
struct EmitterMatch {
  std::vector<std::optional<std::size_t>> of_reports;  ///< For each report; nullopt: none yet.
  std::vector<std::size_t> unreported;                 ///< They can be none of the reported ones.
};

/// The nearest pairs first. An emitter is that of a report as soon as it is placed within its
/// margin, and better than the report does. It is unreported if it is none, is placed within a
/// kilometre, and may not become that of a report that still has none: not within five deviations,
/// since a distance by power can be far off before there are many bearings.
EmitterMatch match_emitters(const std::vector<ReportedEmitter>& reports,
                            const std::vector<HeardEmitter>& heard);

}  // namespace reconnaissance
