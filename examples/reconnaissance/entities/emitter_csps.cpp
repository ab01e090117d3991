#include "emitter_csps.hpp"

#include "threat_conversion.hpp"

namespace reconnaissance {

recon::Identification EmitterClassifier::classify(const recon::PulseTrain& train) {
  if (train.intercepts.empty()) throw recon::NotSure("nothing was received");
  std::vector<Intercept> intercepts;
  for (const recon::Intercept& each : train.intercepts) intercepts.push_back(intercept(each, 0));
  const auto found = classify_(intercepts);
  if (!found) throw recon::NotSure("it needs more pulses of one mode");
  return identification(*found);
}

std::optional<Identification> by_table(std::span<const Intercept> train) {
  return match_table(train.back(), WarnerReceiver(), emitter_library());
}

std::optional<Identification> by_bayes(std::span<const Intercept> train) {
  return classify_bayesian(train.back(), WarnerReceiver(), emitter_library());
}

std::optional<Identification> by_means(std::span<const Intercept> train) {
  return classify_wideband(train, WarnerReceiver(), emitter_library());
}

recon::PlaceEstimate EmitterLocator::locate(const recon::BearingTrack& track) {
  if (track.bearings.empty()) throw recon::NotSure("there is no bearing");
  const auto place =
      place_(bearings_of(track), {track.least_distance_m, track.greatest_distance_m});
  if (!place) throw recon::NotSure("the bearings do not cross well enough yet");
  return place_estimate(*place);
}

}  // namespace reconnaissance
