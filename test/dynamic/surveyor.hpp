#pragma once

#include <atomic>

#include "survey.idl.hpp"

namespace skein::test {

class Surveyor : public survey::ISurveyor {
 public:
  survey::Field measure(const survey::Plot& plot, std::int32_t& corners) override {
    corners = static_cast<std::int32_t>(plot.corners.size());
    if (plot.corners.empty()) throw survey::NoPlot("it has no corner", plot.kind);
    return {plot.corners, 2.5, {}};
  }
  std::string greet(const std::string& name) override { return "Hello, " + name; }
  void forget() override { ++forgotten; }
  void walk(std::int32_t steps, StreamSink<survey::Corner>& out) override {
    for (std::int32_t i = 0; i < steps; ++i) out.push({double(i), 0.5});
  }

  std::atomic<int> forgotten{0};
};

}  // namespace skein::test
