#pragma once

#include "threats.idl.hpp"
#include "threats/air_defence_picture.hpp"

namespace reconnaissance {

/// Tells emitters by their pulses: a CSP of the radar warner.
class EmitterClassifier : public recon::IEmitterClassifier {
 public:
  /// By the intercepts of one emitter, at least one; nullopt: not yet.
  using Classify = std::optional<Identification> (*)(std::span<const Intercept>);

  explicit EmitterClassifier(Classify classify) : classify_(classify) {}
  recon::Identification classify(const recon::PulseTrain& train) override;

 private:
  Classify classify_;
};

std::optional<Identification> by_table(std::span<const Intercept> train);
std::optional<Identification> by_bayes(std::span<const Intercept> train);
std::optional<Identification> by_means(std::span<const Intercept> train);

/// Places emitters by bearings: a CSP of the AD manager.
class EmitterLocator : public recon::IEmitterLocator {
 public:
  using Place = decltype(&by_filter);

  explicit EmitterLocator(Place place) : place_(place) {}
  recon::PlaceEstimate locate(const recon::BearingTrack& track) override;

 private:
  Place place_;
};

}  // namespace reconnaissance
