#pragma once

#include "survey.idl.hpp"

/// Flies one row after the other.
class Surveyor : public survey::ISurveyor {
 public:
  static constexpr double kLimitM2 = 1'000'000;

  double minutes(const survey::Area& area) override {
    const double area_m2 = area.length_m * area.width_m;
    if (area_m2 > kLimitM2) throw survey::TooLarge(kLimitM2);
    return area_m2 / 5000;
  }

  void fly(const survey::Area& area, skein::StreamSink<survey::Photo>& photos) override {
    for (std::uint32_t number = 0; number * 10 < area.length_m; ++number)
      photos.push({number, number * 10.0});
  }
};
