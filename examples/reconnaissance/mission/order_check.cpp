#include "mission/order_check.hpp"

#include <fmt/format.h>

namespace reconnaissance {

std::optional<std::string> contradiction_in(const OrderText& order, const Means& means) {
  const std::string& name = order.name;
  if (order.follow) {
    if (order.follow_s <= 0)
      return fmt::format("{} is to be followed for no time; set 'Follow for'", name);
    if (order.follow_s + means.home_s > means.endurance_s)
      return fmt::format(
          "{} is to be followed for {:.0f} s, {:.0f} s there and back, and the aircraft may be in "
          "the air for {:.0f}",
          name, order.follow_s, means.home_s, means.endurance_s);
    if (order.stand_off_m < means.turn_radius_m)
      return fmt::format(
          "{} is to be circled at {:.0f} m, and the aircraft turns with a radius of {:.0f}", name,
          order.stand_off_m, means.turn_radius_m);
    if (order.stand_off_m > means.greatest_distance_m)
      return fmt::format(
          "{} is to be circled at {:.0f} m, from where a pixel is larger than {:.2f} m: that needs "
          "{:.0f} m at most",
          name, order.stand_off_m, order.wanted_sample_m, means.greatest_distance_m);
  }
  if (order.locate) {
    if (order.within_m <= 0)
      return fmt::format("{} is to be placed within no distance; set 'Located within'", name);
    if (order.stand_off_m <= order.margin_m)
      return fmt::format(
          "{} is to be kept away from by {:.0f} m, and may be {:.0f} m from where it was reported",
          name, order.stand_off_m, order.margin_m);
  }
  return std::nullopt;
}

}  // namespace reconnaissance
