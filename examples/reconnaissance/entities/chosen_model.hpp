#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "flight.idl.hpp"
#include "skein/clock.hpp"
#include "skein/entity.hpp"

namespace reconnaissance {

/// The flight model that flies, of an entity's CSPs. One that is lost is waited for, a while of the
/// system's time, in which the mission's stands; if it does not come back, the next one flies on
/// from the last state until it does. One that refuses is not asked again. What has happened is
/// told on the standard error, in a line each, as soon as one flies. Not thread-safe.
class ChosenModel {
 public:
  /// `names`: which are to fly, the best first; none: whichever the Head takes.
  ChosenModel(skein::Entity& entity, std::vector<std::string> names);

  /// Where the flight begins. Throws skein::Unavailable where none can fly from there, as does
  /// advance().
  void place(const recon::ModelState& state, const std::stop_token& stop);

  recon::ModelState advance(const recon::ModelInput& input, const std::stop_token& stop);

  /// Which one flies.
  const std::string& name() const { return names_.at(flies_); }
  /// How many were lost in flight, and what they have replaced themselves.
  std::uint32_t lost() const { return lost_; }

 private:
  /// Why one does not fly, and whether it may later.
  struct Absence {
    std::string reason;
    bool lost = true;
  };
  /// Returns why better ones do not fly, in a sentence each.
  std::vector<std::string> choose(const std::stop_token& stop);
  std::optional<Absence> await(const std::string& name, const std::stop_token& stop);
  std::optional<Absence> try_to_place(const std::string& name);
  void look_for_best();

  skein::Entity& entity_;
  std::vector<std::string> names_;
  std::size_t flies_ = 0;  // which of them
  recon::ModelState state_;
  std::uint32_t lost_ = 0;
  skein::Instant look_at_{};
  std::optional<recon::IFlightModel::Proxy> model_;
};

}  // namespace reconnaissance
