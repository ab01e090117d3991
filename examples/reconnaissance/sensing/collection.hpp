#pragma once

#include <optional>
#include <vector>

#include "sensing/camera.hpp"

// Three ways to collect an element of interest, each the body of a CSP. All are for a straight
// flight past it, along the road if it is one, with the camera looking aside or down.
namespace reconnaissance {

/// A point (one place) that may be up to `margin_m` away from where it is thought to be, or a road
/// (its corners, in order) with so much of the land on both sides. Heights are those of the ground.
struct Objective {
  std::vector<Local> line;
  double margin_m = 0;
};

/// The flight past the objective.
struct Flyby {
  double height_m;    ///< Above the objective.
  double offset_m;    ///< Of the track from the objective, on the map; 0 is overhead.
  double speed_m_s;   ///< Over ground.
  double course_rad;  ///< Past a point; along a road the road's counts.
};

/// What a camera's mount and its exposures need.
struct CameraMount {
  double slew_rad_s = 1.0;
  double settle_s = 0.3;        ///< After each movement.
  double stare_s = 0.5;         ///< For an image of a step.
  double dwell_s = 3;           ///< On a spot.
  double integration_s = 5e-4;  ///< Of one exposure, in daylight.
  double frames_per_s = 10;
};

/// The camera aims from one place to another at a constant speed; both are the same for a stare.
struct Pointing {
  double begin_s;
  double seconds;
  Local from;
  Local to;
};

struct CollectionPlan {
  std::vector<Pointing> pointings;  ///< In order; gaps between them are movements.
  double seconds;                   ///< From the first movement to the last exposure.
  double early_s;            ///< So long before the middle of the objective is abeam it begins.
  double coverage;           ///< Share of the objective that is seen, by length and width.
  double sample_distance_m;  ///< The coarsest that it has anywhere.
};

/// Frames side by side over the whole objective. They overlap by a fifth in both directions, and by
/// what it takes that they turn as the aircraft flies past. Along a road no frame is taken before
/// it is abeam, if there is the time. nullopt if the frame shows the horizon,
/// or if the flight is too fast: more frames take longer, and turn further.
std::optional<CollectionPlan> plan_step_stare(const Objective& objective, const Flyby& flyby,
                                              const Camera& camera, const CameraMount& mount);

/// Sweeps along the whole objective without a stop, as many as its width needs: one as fast as the
/// aircraft flies, several as fast as it goes. Not faster than half a pixel of smear in an
/// exposure, the mount, and frames that overlap by a fifth allow. The smear adds to the sample
/// distance as the root of squares. nullopt as above.
std::optional<CollectionPlan> plan_line_scan(const Objective& objective, const Flyby& flyby,
                                             const Camera& camera, const CameraMount& mount);

/// A long look at the middle of the objective: the soonest done, with the finest sample, for what
/// fits into one frame. nullopt as above.
std::optional<CollectionPlan> plan_spot(const Objective& objective, const Flyby& flyby,
                                        const Camera& camera, const CameraMount& mount);

/// A look that stays with one place, which moves so: as long as a velocity that is estimated anew
/// once a second can be trusted. nullopt if the frame shows the horizon.
std::optional<CollectionPlan> plan_watch(const Local& place, double north_m_s, double east_m_s,
                                         const Flyby& flyby, const Camera& camera);

/// What a plan costs, for skein::best_by_cost(): its seconds; a thousand more for all of the
/// objective that it leaves out, and for each multiple of `required_m` that its sample is coarser.
double collection_cost(const CollectionPlan& plan, double required_m);

}  // namespace reconnaissance
