#pragma once

#include "battery.idl.hpp"

/// Divides the capacity by the mean power: done at once, blind to what comes when.
class MeanPower : public battery::IEstimator {
 public:
  double endurance_min(const battery::Plan& plan) override;
};

/// Discharges a model of the battery second by second, which loses more the harder it is drawn
/// from, for a thousand guesses of the wind; returns what nine out of ten of them reach.
class Discharge : public battery::IEstimator {
 public:
  double endurance_min(const battery::Plan& plan) override;
};
