#pragma once

#include <string>
#include <vector>

namespace reconnaissance {

/// What the executive (NHP) makes the mission do, in the order of severity.
enum class FlightMode {
  Mission,     ///< As planned.
  Degraded,    ///< As planned, but nothing new is begun that needs what is missing.
  ReturnHome,  ///< The rest of the mission is given up.
  Abort        ///< To the nearest place to land.
};

enum class Cause {
  None,
  FuelLow,
  FuelCritical,
  SensorOut,
  SensorsOut,
  NavigationLost,
  EntityRestarts,
  EntityLost,
  Forecast
};

/// An entity that does not answer at present.
struct MissingEntity {
  std::string name;
  bool required = false;  ///< The profile says that the mission cannot go on without it.
  bool given_up = false;  ///< It is not being restarted any more.
};

/// All that the executive's choice depends on.
struct MissionSituation {
  double fuel_kg = 0;
  double fuel_for_mission_kg = 0;  ///< To finish the plan and fly home from there.
  double fuel_home_kg = 0;         ///< From here.
  double fuel_reserve_kg = 0;
  int sensors = 3;           ///< Redundant navigation channels …
  int sensors_voted_in = 3;  ///< … and those that the voter believes.
  std::vector<MissingEntity> missing;
};

struct ModeDecision {
  FlightMode mode = FlightMode::Mission;
  Cause cause = Cause::None;
  std::string entity;  ///< Whose loss is the cause.
  bool operator==(const ModeDecision&) const = default;
};

/// The least severe mode that is allowed now, by a table of rules of which the most severe that
/// applies decides:
/// | cause                                                  | mode       |
/// | a required entity is missing and given up              | Abort      |
/// | no navigation channel is voted in                      | Abort      |
/// | fuel does not suffice for the way home                 | Abort      |
/// | fuel does not suffice for the way home and the reserve | ReturnHome |
/// | one of several channels is left: nobody outvotes it    | ReturnHome |
/// | an entity is missing, or a channel is out              | Degraded   |
ModeDecision allowed_mode(const MissionSituation& situation);

// The executive's two choices, with the same function. Both remember that Abort and ReturnHome are
// final, but for the loss of an entity, which may come back: fuel does not, and a flight that
// wavers at the limit is worse than either.

class RuleTableExecutive {
 public:
  ModeDecision decide(const MissionSituation& situation);

 private:
  ModeDecision last_;  // final one
};

/// Chooses, of the modes that the rules allow, the one with the greatest expected utility, in
/// shares of the whole mission's value: that value, less the aircraft times the probability to lose
/// it, by fuel (normally distributed about the forecast) and by failures. So it may return before a
/// rule demands it, where the mission is not worth its risk.
class UtilityExecutive {
 public:
  ModeDecision decide(const MissionSituation& situation);

  /// Of going on with the plan, and of flying home now.
  static double utility_of_mission(const MissionSituation& situation);
  static double utility_of_return(const MissionSituation& situation);

 private:
  ModeDecision last_;  // final one
};

}  // namespace reconnaissance
