#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flight.idl.hpp"
#include "geodesy/hills.hpp"
#include "geodesy/local_frame.hpp"
#include "member.hpp"
#include "mission/elements.hpp"
#include "random.hpp"
#include "sensing/camera.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "targets.idl.hpp"

namespace reconnaissance {

/// The electro-optical camera, which it simulates, too. It looks at the element that is next as
/// soon as the flight leads past it; its CSPs know patterns by which to do so, and its Head takes
/// the one that costs least.
class EoManager {
 public:
  EoManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start() { member_.start(); }

 private:
  /// A plan that is carried out, or waits for its beginning.
  struct Collection {
    std::string element;
    recon::CollectionPlan plan;
    double begin_s;
  };
  /// How well each part of an element has been seen; infinite: not at all.
  struct Seen {
    std::vector<recon::Position> line;  ///< Of the element.
    std::vector<Local> parts;
    std::vector<double> sample_m;
    double achieved_m() const;
  };
  struct TrueObject {
    Local place;
    double size_m;
    std::vector<ObjectText::Leg> legs;
    double shown_s;  // in an image, when last
  };

  void work(Tick tick);
  void watch(double now_s, double known_s, const recon::FlightState& state,
             const recon::Element& element);
  void prepare(double now_s, const recon::FlightState& state, const recon::Element& element);
  std::optional<recon::CollectionPlan> ask_plan(const recon::CollectionTask& task,
                                                const recon::Element& element);
  std::optional<recon::Image> take(double now_s, const recon::FlightState& state,
                                   const recon::Truth& truth);
  void find_objects(double now_s, const CameraPose& pose, recon::Image& image);
  void look_at_parts(const CameraPose& pose, Seen& seen) const;
  Local place_of(const TrueObject& object, double now_s) const;
  void tell_truth(Tick tick) const;
  std::vector<Local> line_of(const recon::Element& element) const;

  skein::Entity& entity_;
  LocalFrame frame_;
  Hills ground_;
  std::vector<TrueObject> objects_;
  Random random_;
  std::optional<Collection> collection_;
  std::map<std::string, Seen> seen_;

  Stream<recon::FlightState> flight_;
  Stream<recon::Truth> truth_;
  Stream<recon::ElementList> elements_;
  skein::Publisher<recon::Images> images_;
  mutable skein::Publisher<recon::ObjectTruths> truths_;
  Member member_;
};

}  // namespace reconnaissance
