#pragma once

#include <string>
#include <vector>

#include "planning/link_watch.hpp"

namespace reconnaissance {

/// What the executive (NHP) makes the mission do, in the order of severity.
enum class FlightMode {
  Mission,           ///< As planned.
  Degraded,          ///< As planned, but nothing new is begun that needs what is missing.
  ContingencyRoute,  ///< The route that was agreed for a lost link.
  ReturnHome,        ///< The rest of the mission is given up.
  Abort              ///< To the nearest place to land.
};

enum class Cause {
  None,
  LinkDegraded,
  LinkLost,
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
  Link link = Link::Connected;
  double fuel_kg = 0;
  double fuel_for_mission_kg = 0;  ///< To finish the plan and fly home from there.
  double fuel_home_kg = 0;         ///< From here.
  double fuel_reserve_kg = 0;
  int sensors = 3;           ///< Redundant navigation channels …
  int sensors_voted_in = 3;  ///< … and those that the voter believes.
  std::vector<MissingEntity> missing;
  double value_left = 1;   ///< Of what the plan still collects, as a share of the whole mission's.
  double hazard_left = 0;  ///< ∫ λ dt of the rest of the plan.
};

struct ModeDecision {
  FlightMode mode = FlightMode::Mission;
  Cause cause = Cause::None;
  std::string entity;    ///< Whose loss is the cause.
  bool resumes = false;  ///< The mission goes on after a contingency: plan anew from here.
  bool operator==(const ModeDecision&) const = default;
};

/// The least severe mode that is allowed now, by a table of rules of which the most severe that
/// applies decides:
/// | cause                                                  | mode             |
/// | a required entity is missing and given up              | Abort            |
/// | no navigation channel is voted in                      | Abort            |
/// | fuel does not suffice for the way home                 | Abort            |
/// | fuel does not suffice for the way home and the reserve | ReturnHome       |
/// | one of several channels is left: nobody outvotes it    | ReturnHome       |
/// | the link is lost                                       | ContingencyRoute |
/// | an entity is missing, a channel out, the link degraded | Degraded         |
ModeDecision allowed_mode(const MissionSituation& situation);

// The executive's two choices, with the same function. Both remember that Abort and ReturnHome are
// final: fuel does not come back, and a flight that wavers at the limit is worse than either.

class RuleTableExecutive {
 public:
  ModeDecision decide(const MissionSituation& situation);

 private:
  ModeDecision last_;
};

/// What the modes are worth, in shares of the whole mission's value.
struct UtilityWeights {
  double aircraft = 5;          ///< Its loss costs so many missions.
  double fuel_deviation = 0.1;  ///< Of what a flight burns, relative to what was forecast.
  double hazard_one_channel_out = 0.005;  ///< Until the plan's end, by the next failures.
  double hazard_entity_missing = 0.02;
  double advantage = 0.05;  ///< A change of mode has to bring at least that much.
};

/// Chooses, of the modes that the rules allow, the one with the greatest expected utility: value of
/// what is still collected, less the aircraft times the probability to lose it, by fuel (normally
/// distributed about the forecast), by hazard and by failures. So it may return before a rule
/// demands it, where little is left to collect for what is risked.
class UtilityExecutive {
 public:
  explicit UtilityExecutive(const UtilityWeights& weights = {}) : weights_(weights) {}

  ModeDecision decide(const MissionSituation& situation);

  /// Of going on with the plan, and of flying home now.
  double utility_of_mission(const MissionSituation& situation) const;
  double utility_of_return(const MissionSituation& situation) const;

 private:
  UtilityWeights weights_;
  ModeDecision last_;
};

}  // namespace reconnaissance
