#pragma once

#include <optional>
#include <vector>

#include "flight.idl.hpp"
#include "geodesy/local_frame.hpp"
#include "member.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "threats.idl.hpp"
#include "threats/air_defence_picture.hpp"

namespace reconnaissance {

/// The air defence picture: knows where threats are, how certainly, and how far they reach. Its
/// CSPs place emitters by bearings; its Head chooses among them. Over the link it reports what its
/// own warner has found, and takes in what other aircraft have.
class AdManager {
 public:
  AdManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  void manage(Tick tick);
  bool hear(const recon::EmitterReports& reports);
  bool take_in(Tick tick);
  void report(Tick tick);
  std::optional<skein::fusion::Estimate> locate(std::span<const Bearing> bearings,
                                                const Interval& distances_m);
  void tell(Tick tick);

  skein::Entity& entity_;
  std::optional<LocalFrame> frame_;  // about the first place of the aircraft
  AirDefencePicture picture_{WarnerReceiver()};
  std::vector<Threat> threats_;
  std::vector<Threat> told_;  // of the present epoch
  std::uint32_t epoch_ = 0;
  std::vector<recon::LinkedSite> linked_;  // that was taken in

  Stream<recon::FlightState> flight_;
  Stream<recon::EmitterReports> emitters_;
  skein::Publisher<recon::ThreatPicture> pictures_;
  /// Where there is a link.
  std::optional<Stream<recon::LinkedSites>> joint_;
  std::optional<skein::Publisher<recon::LinkedSites>> reports_;
  Member member_;
};

}  // namespace reconnaissance
