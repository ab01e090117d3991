#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "geodesy/local_frame.hpp"
#include "member.hpp"
#include "mission.idl.hpp"
#include "mission/conduct.hpp"
#include "planning/threat_discs.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "targets.idl.hpp"
#include "threats.idl.hpp"
#include "tour.idl.hpp"

namespace reconnaissance {

/// Leads the mission through its phases. Which elements are collected, in which order and past
/// which side, its CSPs plan and its Head chooses; again when a threat bars the way, and when an
/// element was missed. A target that is found is circled, as long as was ordered. The navigator
/// makes routes of it, which the flight controller is ordered to fly.
class MissionManager : public recon::IMissionManager {
 public:
  MissionManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start();

  void begin(const recon::MissionOrder& order, std::int64_t tick) override;

 private:
  static constexpr double kLookAgain_s = 20;
  using Order = std::optional<Conduct::Order>;

  void manage(Tick tick);
  bool take_order(Tick tick);
  Conduct::Situation situation(Tick tick, const recon::FlightState& state);
  /// What is to be flown in place of what was, if anything.
  Order reconsider(const recon::FlightState& state, const recon::ElementList& elements,
                   const Conduct::Situation& now);
  Order tour(const recon::FlightState& state, const recon::ElementList& elements,
             const std::string& why);
  /// What is flown while a target that was found is watched, or when it is no longer.
  Order pursue(const recon::FlightState& state, const recon::ElementList& elements);
  /// Whether it waits for a tour, in place of landing for want of one.
  Order wait_or_land(const recon::FlightState& state, const recon::ElementList& elements);
  bool is_missed(const recon::Element& element) const;
  bool may_wait(const recon::FlightState& state) const;
  double left_s(Tick tick) const;
  FlightCost take_off_and_landing() const;
  std::vector<CollectionPass> passes_of(const recon::Element& element,
                                        const std::vector<ThreatDisc>& wide) const;
  std::optional<std::string> contradiction(const recon::FlightState& state,
                                           const recon::ElementList& elements) const;
  void loiter(const Circle& circle, Tick tick);
  std::optional<recon::Tour> ask_tour(const recon::TourProblem& problem);
  bool is_barred(const recon::FlightState& state) const;
  bool others_threaten() const;
  bool may_look_again(const Conduct::Situation& now, Tick tick) const;
  void carry_out(const Conduct::Order& order, Tick tick, const recon::FlightState& state);
  recon::Route ask_route(const std::vector<WayPoint>& through, Tick tick,
                         const recon::FlightState& state, double least_survival);
  void tell(Tick tick);

  skein::Entity& entity_;
  std::optional<recon::INavigator::Proxy> navigator_;
  std::optional<recon::IFlightController::Proxy> controller_;
  recon::FlightLimits limits_;
  CruiseFigures cruise_;
  double fuel_reserve_kg_;
  double endurance_s_;

  std::mutex mutex_;
  std::optional<recon::MissionOrder> order_;
  Tick begins_ = 0;

  // Of the mission that is under way; the time's thread alone uses them.
  std::optional<LocalFrame> frame_;
  std::optional<Conduct> conduct_;
  recon::Runway runway_;
  recon::Route route_;                      // that was ordered last
  std::vector<WayPoint> through_;           // what it was to lead over
  std::vector<ThreatDisc> threats_;         // as last seen
  std::vector<ThreatDisc> certain_;         // of their reach what is sure
  FlightCost suffered_;                     // by what was heard of weapons that guide,
  Tick looked_ = 0;                         // until then
  double planned_area_m2_ = 0;              // that they reached over at the last plan
  double planned_s_ = 0;                    // when that was
  double look_again_s_ = kLookAgain_s;      // after it, while it flies home for want of a tour
  bool waits_ = false;                      // for one
  double barring_hazard_ = 0;               // of the rest of the route, from which on it is barred
  std::vector<std::string> tour_;           // the elements that it passes,
  std::size_t passed_ = 0;                  // of which so many were passed
  std::map<std::string, int> tries_;        // and how often, each
  std::size_t planned_for_ = 0;             // so many were known when it was planned
  std::optional<std::string> return_home_;  // as the executive wants, and why
  std::optional<Circle> circle_;            // that is flown about a target
  Local told_circle_{};                     // the centre of that which was told last
  bool nothing_new_ = false;                // likewise
  std::optional<Tick> took_off_;
  Tick heard_ = 0;  // when a set of sensors was, last
  int tours_ = 0;   // that were asked for
  std::optional<recon::MissionStatus> told_;

  Stream<recon::FlightState> flight_;
  Stream<recon::MissionMode> mode_;
  Stream<recon::ThreatPicture> pictures_;
  Stream<recon::ElementList> elements_;
  skein::Publisher<recon::MissionStatus> status_;
  skein::Publisher<recon::RouteTaken> taken_;
  Member member_;
};

}  // namespace reconnaissance
