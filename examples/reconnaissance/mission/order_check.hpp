#pragma once

#include <optional>
#include <string>

namespace reconnaissance {

/// What an order asks for one element; what is not asked for is 0.
struct OrderText {
  std::string name;
  bool follow = false;  ///< A target is to be followed,
  bool locate = false;  ///< or an emitter to be placed.
  double follow_s = 0;
  double within_m = 0;  ///< An emitter's place.
  double stand_off_m = 0;
  double margin_m = 0;
  double wanted_sample_m = 0;
};

/// With what it is to be carried out.
struct Means {
  double turn_radius_m = 0;
  double endurance_s = 0;
  double home_s = 0;               ///< At least, to the element and back.
  double greatest_distance_m = 0;  ///< On the map, from which images are as fine as wanted.
};

/// Why nobody could carry out an order; nullopt if nothing speaks against it.
std::optional<std::string> contradiction_in(const OrderText& order, const Means& means);

}  // namespace reconnaissance
