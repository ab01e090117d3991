#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flight.idl.hpp"
#include "member.hpp"
#include "sensing/tracking/followed_target.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "targets.idl.hpp"
#include "threats.idl.hpp"

namespace reconnaissance {

/// What a profile wants of all elements: `images`, `follow` or `locate`. Throws
/// skein::InvalidArgument for another word.
recon::ElementTask task_of(const std::string& text);

/// Knows the elements of interest, and how well each has been seen. Its CSPs are policies which one
/// is next; its Head takes the best. Where the order is to follow targets or to place emitters, it
/// takes them from tracks and from the threat picture instead of images.
class EoiManager {
 public:
  EoiManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  void manage(Tick tick);
  void see(const recon::Images& images);
  void locate(const recon::ObjectTracks& tracks);
  void follow(double now_s, const recon::ObjectTracks& tracks);
  void place(const recon::ThreatPicture& picture);
  static void place(recon::Element& element, const recon::Threat& threat);
  std::int32_t choose(const recon::FlightState& state);
  std::int32_t ask_policy(const recon::ElementChoice& choice);

  skein::Entity& entity_;
  recon::ElementTask task_;
  recon::Element order_;  // what is wanted of each
  std::vector<recon::Element> elements_;
  std::vector<recon::Element> ordered_;  // as they were
  std::vector<FollowedTarget> targets_;
  std::map<std::string, double> imaged_s_;  // when an image was taken for an element, last

  Stream<recon::FlightState> flight_;
  Stream<recon::Images> images_;
  Stream<recon::ObjectTracks> tracks_;
  std::optional<Stream<recon::ThreatPicture>> pictures_;  // where it is to place emitters
  skein::Publisher<recon::ElementList> lists_;
  Member member_;
};

}  // namespace reconnaissance
