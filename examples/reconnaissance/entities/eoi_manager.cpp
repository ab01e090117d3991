#include "eoi_manager.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "convert.hpp"
#include "deciding.hpp"
#include "mission/elements.hpp"
#include "mission/emitters.hpp"
#include "mission/places.hpp"
#include "mission/sharing.hpp"
#include "skein/error.hpp"
#include "target_conversion.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

// Of a place as it was ordered.
constexpr double kOrderedDeviation_m = 50;
// What was found so near belongs to the element.
constexpr double kBelongs_m = 200;
// A target that is not on the road where it was reported has driven on, so far at most.
constexpr double kDrivenOn_m = 2500;
// A search is over when no image has been taken for so long.
constexpr double kSearchOver_s = 5;

/// All that are ordered, or the share of this aircraft where there are others.
std::vector<ElementText> elements_of(const skein::Entity& entity,
                                     const skein::ParameterValues& values) {
  auto elements = parse_elements(values.find<std::string>("Elements").value_or(""));
  const auto aircraft = parse_names(values.find<std::string>("Aircraft").value_or(""));
  if (aircraft.empty()) return elements;
  const auto own = std::ranges::find(aircraft, entity.options().system);
  std::vector<Geodetic> starts;
  for (const RunwayText& each : parse_runways(values.find<std::string>("Runways").value_or("")))
    starts.push_back(each.threshold);
  if (own == aircraft.end() || starts.size() != aircraft.size())
    throw skein::InvalidArgument(fmt::format(
        "parameters 'Aircraft' and 'Runways': {} aircraft with {} runways are to share the "
        "elements, and {} has to be one of them",
        aircraft.size(), starts.size(), entity.options().system));
  return share_of(elements, starts, static_cast<std::size_t>(own - aircraft.begin()));
}

std::vector<Eigen::Vector2d> on_map(const std::vector<Local>& line) {
  std::vector<Eigen::Vector2d> places;
  for (const Local& each : line) places.emplace_back(each.north_m, each.east_m);
  return places;
}

double greatest_deviation_m(const GroundEstimate& estimate) {
  const Eigen::Matrix2d place = estimate.covariance.topLeftCorner<2, 2>();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(place).eigenvalues().maxCoeff());
}

}  // namespace

recon::ElementTask task_of(const std::string& text) {
  if (text == "images") return recon::ElementTask::TakeImages;
  if (text == "follow") return recon::ElementTask::FollowTarget;
  if (text == "locate") return recon::ElementTask::LocateEmitter;
  throw skein::InvalidArgument("'" + text + "' is no task; there are images, follow and locate");
}

EoiManager::EoiManager(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      task_(task_of(values.find<std::string>("Task").value_or("images"))),
      flight_(entity, topic::kFlightState),
      images_(entity, topic::kImages, {}),
      tracks_(entity, topic::kTracks, skein::TopicQos::state()),
      lists_(entity.publisher<recon::ElementList>(topic::kElements.name, skein::TopicQos::state())),
      member_(entity, values, [this](Tick tick) { manage(tick); }) {
  order_.task = task_;
  order_.priority = 1;
  order_.stand_off_m = values.find<double>("Stand off").value_or(0);
  order_.wanted_deviation_m = values.find<double>("Located within").value_or(0);
  if (const auto wanted = values.find<std::chrono::duration<double>>("Follow for"))
    order_.wanted_s = wanted->count();
  for (const ElementText& each : elements_of(entity, values)) {
    recon::Element element = order_;
    element.name = each.name;
    for (const Geodetic& place : each.line) element.line.push_back(position(place));
    element.margin_m = each.margin_m;
    element.priority = each.priority;
    element.size_m = each.size_m;
    element.wanted_ground_sample_m = each.wanted_sample_m;
    elements_.push_back(std::move(element));
  }
  ordered_ = elements_;
  if (task_ == recon::ElementTask::LocateEmitter)
    pictures_.emplace(entity, topic::kThreats, skein::TopicQos::state());
}

void EoiManager::manage(Tick tick) {
  for (const recon::Images& batch : images_.take(tick)) see(batch);
  if (const auto tracks = tracks_.at(tick)) {
    if (task_ == recon::ElementTask::FollowTarget)
      follow(seconds_of(tick), *tracks);
    else if (task_ == recon::ElementTask::TakeImages)
      locate(*tracks);
  }
  if (pictures_)
    if (const auto picture = pictures_->at(tick)) place(*picture);
  const auto state = flight_.at(tick);
  lists_.publish({tick, elements_, state ? choose(*state) : -1});
}

void EoiManager::see(const recon::Images& images) {
  for (const recon::Image& image : images.images) {
    for (recon::Element& element : elements_) {
      if (element.name != image.element) continue;
      imaged_s_[element.name] = seconds_of(images.tick);
      if (task_ != recon::ElementTask::TakeImages || image.achieved_ground_sample_m == 0) continue;
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
      const double deviation_m = greatest_deviation_m(each.estimate);
      if (belongs && (element.deviation_m == 0 || deviation_m < element.deviation_m))
        element.deviation_m = deviation_m;
    }
  }
}

void EoiManager::follow(double now_s, const recon::ObjectTracks& told) {
  if (imaged_s_.empty()) return;
  const LocalFrame frame(geodetic(told.origin));
  const std::vector<Track> all = tracks(told.tracks);
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    recon::Element& element = elements_[i];
    if (targets_.size() == i)
      targets_.emplace_back(on_map(locals(frame, element.line)), element.margin_m + kBelongs_m);
    if (element.collected) continue;
    FollowedTarget& target = targets_[i];
    target.look(now_s, all);
    const auto imaged = imaged_s_.find(element.name);
    if (!target.was_ever_found() && imaged != imaged_s_.end() &&
        now_s - imaged->second > kSearchOver_s) {
      const auto road = prolonged(locals(frame, ordered_[i].line), kDrivenOn_m);
      target.expect_along(on_map(road));
      element.line.clear();
      for (const Local& corner : road) element.line.push_back(position(frame, corner));
    }
    element.followed_s = target.followed_s();
    element.collected = element.followed_s >= element.wanted_s;
    const bool was_found = element.found;
    element.found = target.found() && !element.collected;
    if (!was_found && !element.found) continue;
    const GroundState& state = target.estimate().mean;
    element.line = {position(frame, Local{state[0], state[1], 0})};
    element.north_m_s = element.found ? state[2] : 0;
    element.east_m_s = element.found ? state[3] : 0;
    element.deviation_m = greatest_deviation_m(target.estimate());
  }
}

/// Emitters that were reported, and those that were heard where none was.
void EoiManager::place(const recon::ThreatPicture& picture) {
  if (picture.threats.empty()) return;
  const LocalFrame frame(geodetic(picture.threats.front().position));
  std::vector<ReportedEmitter> reports;
  for (const recon::Element& each : ordered_)
    reports.push_back({local(frame, each.line.front()), each.margin_m});
  std::vector<HeardEmitter> heard;
  for (const recon::Threat& each : picture.threats)
    heard.push_back({local(frame, each.position), each.deviation_m});
  const EmitterMatch match = match_emitters(reports, heard);
  for (std::size_t i = 0; i < reports.size(); ++i)
    if (match.of_reports[i]) place(elements_[i], picture.threats[*match.of_reports[i]]);
  for (const std::size_t index : match.unreported) {
    const recon::Threat& threat = picture.threats[index];
    const std::string name = fmt::format("{} {}", threat.kind, threat.number);
    auto element = std::ranges::find(elements_, name, &recon::Element::name);
    if (element == elements_.end()) {
      element = elements_.insert(element, order_);
      element->name = name;
    }
    place(*element, threat);
  }
}

void EoiManager::place(recon::Element& element, const recon::Threat& threat) {
  element.found = true;
  element.line = {threat.position};
  element.deviation_m = threat.deviation_m;
  element.collected = element.collected || placed_within_m(element) <= element.wanted_deviation_m;
}

/// A target that was found is not let out of sight. Else of those that are not collected and lie
/// ahead.
std::int32_t EoiManager::choose(const recon::FlightState& state) {
  if (task_ == recon::ElementTask::LocateEmitter) return -1;
  const auto watched = std::ranges::find(elements_, true, &recon::Element::found);
  if (watched != elements_.end()) return static_cast<std::int32_t>(watched - elements_.begin());
  recon::ElementChoice choice;
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
