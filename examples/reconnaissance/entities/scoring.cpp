#include "scoring.hpp"

#include <fmt/format.h>

#include <cmath>

#include "convert.hpp"
#include "stream.hpp"
#include "target_conversion.hpp"
#include "topics.hpp"

namespace reconnaissance {

Scoring::Scoring(const InSystem& system, const LocalFrame& frame,
                 const skein::ParameterValues& values)
    : system_(system),
      frame_(frame),
      within_m_(values.find<double>("Located within").value_or(500)),
      within_s_(values.find<std::chrono::duration<double>>("Reported within")
                    .value_or(std::chrono::duration<double>(120))
                    .count()),
      score_({values.find<std::chrono::duration<double>>("Follow for")
                  .value_or(std::chrono::duration<double>(PursuitConditions{}.ordered_s))
                  .count(),
              values.find<double>("Least in view").value_or(PursuitConditions{}.least_in_view),
              values.find<double>("Greatest track error")
                  .value_or(PursuitConditions{}.greatest_error_m)}) {
  hear<recon::ElementList>(topic::kElements.name, all_of_state());
  hear<recon::ObjectTruths>(topic::kObjects.name);
  hear<recon::ThreatTruth>(topic::kThreatTruth.name);
  hear<recon::ThreatPicture>(topic::kThreats.name, all_of_state());
}

std::vector<Check> Scoring::checks() const {
  std::lock_guard lock(mutex_);
  switch (task_) {
    case recon::ElementTask::FollowTarget:
      return score_.checks();
    case recon::ElementTask::LocateEmitter: {
      std::vector<Check> checks = site_checks(sites_, reported_, within_m_);
      checks.push_back(delays_.check(within_s_));
      return checks;
    }
    case recon::ElementTask::TakeImages:
      break;
  }
  return {};
}

void Scoring::see(const recon::ElementList& list) {
  std::lock_guard lock(mutex_);
  if (list.elements.empty()) return;
  task_ = list.elements.front().task;
  const recon::Element& target = list.elements.front();
  score_.report(std::llround(seconds_of(list.tick)),
                target.found ? std::optional(local(frame_, target.line.front())) : std::nullopt);
}

/// The first one is the target.
void Scoring::see(const recon::ObjectTruths& truths) {
  std::lock_guard lock(mutex_);
  if (truths.objects.empty()) return;
  const recon::ObjectTruth& target = truths.objects.front();
  score_.truth(std::llround(seconds_of(truths.tick)), local(frame_, target.position),
               target.in_view);
}

void Scoring::see(const recon::ThreatTruth& truth) {
  std::lock_guard lock(mutex_);
  sites_.clear();
  std::vector<ReportDelays::Heard> heard;
  for (const recon::SiteTruth& each : truth.sites) {
    sites_.push_back({each.kind, local(frame_, each.position)});
    heard.push_back({sites_.back(), each.heard});
  }
  delays_.truth(seconds_of(truth.tick), heard);
}

void Scoring::see(const recon::ThreatPicture& picture) {
  std::lock_guard lock(mutex_);
  reported_.clear();
  for (const recon::Threat& each : picture.threats)
    reported_.push_back({each.kind, local(frame_, each.position)});
  delays_.report(seconds_of(picture.tick), reported_);
}

std::string how_collected(recon::ElementTask task) {
  switch (task) {
    case recon::ElementTask::FollowTarget:
      return "followed as long as was ordered";
    case recon::ElementTask::LocateEmitter:
      return "placed as exactly as was ordered";
    case recon::ElementTask::TakeImages:
      break;
  }
  return "collected as finely as they were ordered";
}

std::string collected_text(const recon::Element& element) {
  switch (element.task) {
    case recon::ElementTask::FollowTarget:
      return fmt::format("followed for {:.0f} s, wanted {:.0f}", element.followed_s,
                         element.wanted_s);
    case recon::ElementTask::LocateEmitter:
      return fmt::format("placed within {:.0f} m, wanted {:.0f}", placed_within_m(element),
                         element.wanted_deviation_m);
    case recon::ElementTask::TakeImages:
      break;
  }
  return fmt::format("collected: {:.2f} m a pixel, wanted {:.2f}", element.achieved_ground_sample_m,
                     element.wanted_ground_sample_m);
}

}  // namespace reconnaissance
