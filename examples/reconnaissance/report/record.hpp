#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geodesy/local_frame.hpp"
#include "mission/verdict.hpp"

/// What is told of a mission that was flown. Times are seconds of the mission. Places are about the
/// record's origin. Angles are in radians, courses clockwise from true north.
namespace reconnaissance {

/// The aircraft at one instant, as it truly was.
struct TrackPoint {
  double time_s = 0;
  Local place{};
  double height_above_ground_m = 0;
  double airspeed_m_s = 0;
  double ground_speed_m_s = 0;
  double heading_rad = 0;
  double climb_rad = 0;
  double bank_rad = 0;  ///< Positive: to the right.
  double fuel_kg = 0;
};

/// Another aircraft, while it was there.
struct OtherTrack {
  struct Point {
    double time_s = 0;
    Local place{};
  };
  std::uint32_t number = 0;
  std::vector<Point> points;
  std::string name = {};  ///< Of one that is of the mission, too.
};

/// A route that was flown from then on.
struct PlannedRoute {
  double from_s = 0;
  std::string planner;
  std::vector<Local> points;
};

/// A site of the air defence as it was known.
struct KnownThreat {
  std::uint32_t number = 0;
  std::string kind;
  double from_s = 0;  ///< When it was first known.
  Local place{};
  double deviation_m = 0;  ///< Of the place, in the worst direction.
  double detection_range_m = 0;
  double lethal_range_m = 0;
};

/// Ground above which nobody may fly.
struct NoFlyZone {
  std::string name;
  std::vector<Local> outline;
};

/// An element of interest.
struct Target {
  std::string name;
  std::vector<Local> line;  ///< One place, or the corners of a road.
  double priority = 1;
  double wanted_sample_m = 0;    ///< The size of a pixel on the ground.
  double achieved_sample_m = 0;  ///< 0: not all of it was seen.
  double deviation_m = 0;        ///< Of what was found there; 0: nothing was.
  std::optional<double> collected_s;
  double wanted_s = 0;  ///< It is to be followed for so long, where it is not 0, and was
  double followed_s = 0;
  double wanted_deviation_m = 0;  ///< It is an emitter that is to be placed so, where it is not 0.
  std::vector<OtherTrack::Point> path;  ///< Where it was followed.
};

/// What truly was on the ground, and where it went.
struct TrueThing {
  std::string name;
  std::vector<OtherTrack::Point> points;
};

/// The ground that an image shows.
struct ImagedGround {
  double time_s = 0;
  std::string target;
  std::vector<Local> corners;
  double sample_m = 0;
};

/// Something that lasts until the next one of its kind begins.
struct Stage {
  double from_s = 0;
  std::string name;
  std::string reason;
};

/// One that was asked, and what came of it.
struct Answer {
  std::string name;
  std::string outcome;  ///< In words: accepted, timed out.
  std::string reason;   ///< Why it was asked.
  double took_s = 0;    ///< By the system's clock.
};

struct DecisionTold {
  double time_s = 0;
  std::string entity;
  std::string question;
  std::string chosen;  ///< Empty: there was no result.
  std::string reason;  ///< In plain words.
  std::vector<Answer> answers;
  double took_s = 0;  ///< By the system's clock.
  bool late = false;  ///< Somebody asked did not answer in time.
};

enum class FaultKind { Sensors, Traffic, Site, Csp };

/// Something that broke or came in the way, and what became of it.
struct Fault {
  double from_s = 0;
  std::optional<double> until_s;  ///< Healed.
  std::string what;
  std::string noticed_by;
  double noticed_s = 0;
  std::string answer;  ///< What was done about it.
  FaultKind kind = FaultKind::Csp;
};

/// Something unusual.
struct Flag {
  double time_s = 0;
  bool severe = false;
  std::string text;
};

/// How long calls of one kind took, by the system's clock.
struct Latencies {
  std::string name;
  std::vector<double> seconds;
};

/// Heights of the ground in rows from south to north, each from west to east.
struct GroundGrid {
  double south_m = 0;
  double west_m = 0;
  double spacing_m = 0;
  std::size_t columns = 0;
  std::vector<double> heights_m;
};

struct MissionRecord {
  std::string mission;
  std::string command;  ///< That flies it again.
  Geodetic origin{};
  Verdict verdict;
  double tracked_s = 0;  ///< By sites that can shoot.
  double survival = 1;
  std::size_t lost_samples = 0;
  GroundGrid ground;
  std::vector<TrackPoint> track;
  std::vector<OtherTrack> others;
  std::vector<PlannedRoute> routes;
  std::vector<KnownThreat> threats;
  std::vector<NoFlyZone> zones;
  std::vector<Target> targets;
  std::vector<TrueThing> truths;  ///< Where the order is to follow or to place.
  std::vector<ImagedGround> footprints;
  std::vector<Stage> phases;
  std::vector<Stage> modes;
  std::vector<DecisionTold> decisions;
  std::vector<Fault> faults;
  std::vector<Flag> flags;  ///< Beside those that the rest of the record makes.
  std::vector<Latencies> latencies;
};

}  // namespace reconnaissance
