#pragma once

#include <string>
#include <vector>

#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// What is to be reconnoitred, as a profile names it: `name priority size resolution margin` and
/// one place or the corners of a road, `latitude longitude` each; separated by semicolons. Sizes in
/// metres, places in degrees. Heights are 0.
struct ElementText {
  std::string name;
  double priority = 1;
  double size_m = 5;
  double wanted_sample_m = 0.3;
  double margin_m = 0;
  std::vector<Geodetic> line;
};

/// Throws skein::InvalidArgument with what is wrong.
std::vector<ElementText> parse_elements(const std::string& text);

/// What truly is on the ground, as a profile names it: `latitude longitude size course speed`, then
/// `seconds course speed` for each change; separated by semicolons. It moves on along its course
/// from the mission's beginning, or from so many seconds after it.
struct ObjectText {
  struct Leg {
    double from_s = 0;
    double course_rad = 0;
    double speed_m_s = 0;
  };
  Geodetic place{};
  double size_m = 0;
  std::vector<Leg> legs;
};
std::vector<ObjectText> parse_objects(const std::string& text);

/// Where an object is that began at `start`.
Local moved(const Local& start, const std::vector<ObjectText::Leg>& legs, double now_s);

/// Where an aircraft passes a place if it flies straight on.
struct Passage {
  double ahead_m;   ///< Until the place is abeam; negative: since.
  double offset_m;  ///< Of the track from the place; positive: the place is to the right.
};
Passage passage(const Local& aircraft, double course_rad, const Local& place);

/// Whether that is still to come, and near enough for a camera.
bool is_ahead(const Passage& passage);

/// The middle of a line by its length.
Local middle_of(const std::vector<Local>& line);

/// A road, and straight on from both of its ends; a single place stays as it is.
std::vector<Local> prolonged(std::vector<Local> line, double by_m);

/// Places along a line, no further apart than that; its corners are among them.
std::vector<Local> parts_of_line(const std::vector<Local>& line, double spacing_m);

}  // namespace reconnaissance
