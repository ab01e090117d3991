#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "geodesy/hills.hpp"
#include "geodesy/local_frame.hpp"
#include "ground_station.hpp"
#include "member.hpp"
#include "mission/verdict.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "threat_link.hpp"

namespace reconnaissance {

/// The ground station's mission: that of the aircraft of its own system, or of several aircraft,
/// each of a system of its own (the parameter `Aircraft`), which it begins together and judges by
/// one verdict. It is the middle of the link on which they share their threat pictures.
class Station {
 public:
  Station(skein::Entity& entity, const skein::ParameterValues& values);

  /// Returns at the mission's end, with its exit code (see exit_code()).
  int run(const std::stop_token& told_to_end);

 private:
  Verdict joint(const std::vector<Verdict>& verdicts) const;
  void write(const Verdict& verdict) const;

  skein::Entity& entity_;
  std::filesystem::path results_;
  std::string mission_;  // its name, and the command that flies it again
  std::string command_;
  Geodetic origin_;
  Hills ground_;
  std::deque<GroundStation> aircraft_;
  std::optional<ThreatLink> link_;
  Member member_;
};

}  // namespace reconnaissance
