#pragma once

#include <optional>
#include <string>

#include "geodesy/local_frame.hpp"
#include "place.idl.hpp"
#include "planning/stand_off.hpp"
#include "skein/entity.hpp"
#include "targets.idl.hpp"
#include "tour.idl.hpp"

namespace reconnaissance {

/// A way to choose a circle: a CSP of the mission manager.
class StandOff : public recon::IStandOff {
 public:
  using Choose = std::optional<Circle> (*)(const StandOffTask&);

  explicit StandOff(Choose choose) : choose_(choose) {}
  recon::LoiterCircle circle(const recon::LoiterTask& task) override;

 private:
  Choose choose_;
};

/// From which circle the Head has a target watched; nullopt if no CSP has one that serves.
std::optional<Circle> ask_circle(skein::Entity& entity, const std::string& target,
                                 const StandOffTask& task);

/// A circle as reports show a route.
inline constexpr const char* kCircle = "circle";
recon::Route drawn(const Circle& circle, const LocalFrame& frame, std::uint32_t number);

/// Why the order for an element cannot be carried out by who has `endurance_s`; nullopt if it can.
std::optional<std::string> contradiction_in(const recon::Element& element, double distance_m,
                                            const CruiseFigures& cruise, double endurance_s,
                                            double height_m);

/// On the map, from where images of an element from so far above it are as fine as was ordered.
double greatest_distance_m(const recon::Element& element, double height_m);

}  // namespace reconnaissance
