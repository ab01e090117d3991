#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>

namespace skein::test {

/// What recorded tracks show, by nobody's arithmetic but its own.
struct TrackExtremes {
  double least_clearance_m = std::numeric_limits<double>::infinity();  ///< 5 km from the start on.
  double greatest_bank_deg = 0;         ///< That a coordinated turn as tight as the track's needs.
  double greatest_climb_deg = 0;        ///< Up or down.
  double longest_not_well_clear_s = 0;  ///< Within 0.66 nmi and 450 ft of another aircraft.
  std::size_t others = 0;               ///< Of which there are tracks.
  double flown_s = 0;
  double flown_m = 0;
};

/// Reads lines of `time_s,aircraft,latitude_deg,longitude_deg,height_m,height_above_ground_m`
/// behind a first line of names. Aircraft 0 is judged, others are kept clear of. Throws
/// std::runtime_error for what is no such file.
TrackExtremes extremes_of(const std::filesystem::path& tracks);

/// A place on the ground, as aircraft 0 passed it where it was nearest on the map.
struct Pass {
  double beside_m = std::numeric_limits<double>::infinity();
  double above_ground_m = 0;

  /// How far apart on level ground two rays are that leave the aircraft there with that angle
  /// between them, one above the other: of neighbouring pixels, the ground sample distance.
  double sample_m(double pixel_rad) const;
};
Pass pass_by(const std::filesystem::path& tracks, double latitude_deg, double longitude_deg);

/// For how long aircraft 0 was within that distance of a place, on the map.
double seconds_within(const std::filesystem::path& tracks, double latitude_deg,
                      double longitude_deg, double distance_m);

}  // namespace skein::test
