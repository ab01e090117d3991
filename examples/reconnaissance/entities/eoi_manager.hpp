#pragma once

#include <vector>

#include "flight.idl.hpp"
#include "member.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "targets.idl.hpp"

namespace reconnaissance {

/// Knows the elements of interest, and how well each has been seen. Its CSPs are policies which one
/// is next; its Head takes the best.
class EoiManager {
 public:
  EoiManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  void manage(Tick tick);
  void see(const recon::Images& images);
  void locate(const recon::ObjectTracks& tracks);
  std::int32_t choose(Tick tick, const recon::FlightState& state);
  std::int32_t ask_policy(const recon::ElementChoice& choice);

  skein::Entity& entity_;
  std::vector<recon::Element> elements_;

  Stream<recon::FlightState> flight_;
  Stream<recon::Images> images_;
  Stream<recon::ObjectTracks> tracks_;
  skein::Publisher<recon::ElementList> lists_;
  Member member_;
};

}  // namespace reconnaissance
