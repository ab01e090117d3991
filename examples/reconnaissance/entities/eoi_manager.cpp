#include "eoi_manager.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "convert.hpp"
#include "deciding.hpp"
#include "mission/elements.hpp"
#include "target_conversion.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

// Of a place as it was ordered.
constexpr double kOrderedDeviation_m = 50;
// What was found so near belongs to the element.
constexpr double kBelongs_m = 200;

double greatest_deviation_m(const Track& track) {
  const Eigen::Matrix2d place = track.estimate.covariance.topLeftCorner<2, 2>();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(place).eigenvalues().maxCoeff());
}

}  // namespace

EoiManager::EoiManager(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      flight_(entity, topic::kFlightState),
      images_(entity, topic::kImages, {}),
      tracks_(entity, topic::kTracks, skein::TopicQos::state()),
      lists_(entity.publisher<recon::ElementList>(topic::kElements.name, skein::TopicQos::state())),
      member_(entity, values, [this](Tick tick) { manage(tick); }) {
  for (const ElementText& each :
       parse_elements(values.find<std::string>("Elements").value_or(""))) {
    recon::Element element;
    element.name = each.name;
    for (const Geodetic& place : each.line) element.line.push_back(position(place));
    element.margin_m = each.margin_m;
    element.priority = each.priority;
    element.size_m = each.size_m;
    element.wanted_ground_sample_m = each.wanted_sample_m;
    elements_.push_back(std::move(element));
  }
}

void EoiManager::manage(Tick tick) {
  for (const recon::Images& batch : images_.take(tick)) see(batch);
  if (const auto tracks = tracks_.at(tick)) locate(*tracks);
  const auto state = flight_.at(tick);
  lists_.publish({tick, elements_, state ? choose(tick, *state) : -1});
}

void EoiManager::see(const recon::Images& images) {
  for (const recon::Image& image : images.images) {
    for (recon::Element& element : elements_) {
      if (element.name != image.element || image.achieved_ground_sample_m == 0) continue;
      element.achieved_ground_sample_m = image.achieved_ground_sample_m;
      element.collected = element.achieved_ground_sample_m <= element.wanted_ground_sample_m;
    }
  }
}

/// How certain the place is of what was found at an element.
void EoiManager::locate(const recon::ObjectTracks& told) {
  const LocalFrame frame(geodetic(told.origin));
  for (recon::Element& element : elements_) {
    const auto line = parts_of_line(locals(frame, element.line), kBelongs_m);
    for (const Track& each : tracks(told.tracks)) {
      const Eigen::Vector2d place = each.estimate.place_m();
      const bool belongs = std::ranges::any_of(line, [&](const Local& part) {
        return std::hypot(part.north_m - place[0], part.east_m - place[1]) < kBelongs_m;
      });
      const double deviation_m = greatest_deviation_m(each);
      if (belongs && (element.deviation_m == 0 || deviation_m < element.deviation_m))
        element.deviation_m = deviation_m;
    }
  }
}

/// Of those that are not collected and lie ahead.
std::int32_t EoiManager::choose(Tick tick, const recon::FlightState& state) {
  recon::ElementChoice choice{{}, seconds_of(tick)};
  const LocalFrame frame(geodetic(state.position));
  const double course_rad = std::atan2(state.east_m_s, state.north_m_s);
  const double speed_m_s = std::max(1.0, std::hypot(state.north_m_s, state.east_m_s));
  for (const recon::Element& each : elements_) {
    const Passage pass = passage({}, course_rad, middle_of(locals(frame, each.line)));
    choice.elements.push_back({each.priority, each.size_m, each.wanted_ground_sample_m,
                               each.achieved_ground_sample_m,
                               each.deviation_m > 0 ? each.deviation_m : kOrderedDeviation_m,
                               !each.collected && is_ahead(pass), pass.ahead_m / speed_m_s});
  }
  const bool any = std::ranges::any_of(choice.elements, &recon::ElementOutlook::reachable);
  return any ? ask_policy(choice) : -1;
}

std::int32_t EoiManager::ask_policy(const recon::ElementChoice& choice) {
  skein::Task<recon::IElementPolicy, std::int32_t> task;
  task.request = "next element";
  task.features = {{"elements", static_cast<double>(choice.elements.size())}};
  task.run = [&](recon::IElementPolicy::Proxy& policy, skein::Duration) {
    return policy.next(choice);
  };
  task.evaluate.check("can be reached", [&](const std::int32_t& next) {
    const auto index = static_cast<std::size_t>(next);
    const bool reachable =
        next >= 0 && index < choice.elements.size() && choice.elements[index].reachable;
    return next == -1 || reachable
               ? std::nullopt
               : std::optional(fmt::format("element {} is not ahead, or not wanted", next));
  });
  return decide(entity_, task).value_or(-1);
}

}  // namespace reconnaissance
