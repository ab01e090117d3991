#include "eo_manager.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "convert.hpp"
#include "deciding.hpp"
#include "sensing/target_detection.hpp"
#include "target_conversion.hpp"
#include "target_csps.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// Parts of a road that are looked at for themselves.
constexpr double kParts_m = 50;
// So long before an element is abeam its collection is planned, once a second, until it begins.
constexpr double kAhead_s = 60;
// It is not planned for a road that crosses the track, nor in a turn.
constexpr double kAlong_rad = 0.35;
constexpr double kLevel_rad = 0.1;
// Of a pattern that is worth beginning.
constexpr double kLeastCoverage = 0.5;
// Of the sample that is wanted: a plan's is the coarsest anywhere. One that is coarser is of a pass
// too near or too short, and would last long beyond it.
constexpr double kCoarsest = 1.5;
// An object that the last image showed, ten of which are taken a second, is in view.
constexpr double kShownNow_s = 0.15;

Local on_ground(const Hills& ground, Local place) {
  place.height_m = ground(place.north_m, place.east_m);
  return place;
}

const recon::CameraPointing* pointing_at(const recon::CollectionPlan& plan, double time_s) {
  for (const recon::CameraPointing& each : plan.pointings)
    if (time_s >= each.begin_s && time_s <= each.begin_s + each.seconds) return &each;
  return nullptr;
}

Local aim_of(const recon::CameraPointing& pointing, double time_s) {
  const double share = (time_s - pointing.begin_s) / std::max(pointing.seconds, 1e-3);
  return {std::lerp(pointing.from.north_m, pointing.to.north_m, share),
          std::lerp(pointing.from.east_m, pointing.to.east_m, share),
          std::lerp(pointing.from.height_m, pointing.to.height_m, share)};
}

/// Puts a road in the order in which it is passed; false if it crosses the track.
bool put_along(std::vector<Local>& line, double course_rad) {
  if (line.size() < 2) return true;
  const double along_rad = course_between_rad(line.front(), line.back());
  const double difference = std::abs(std::remainder(along_rad - course_rad, 2 * std::numbers::pi));
  const bool against = difference > std::numbers::pi / 2;
  if (against) std::ranges::reverse(line);
  return (against ? std::numbers::pi - difference : difference) < kAlong_rad;
}

}  // namespace

double EoManager::Seen::achieved_m() const {
  if (sample_m.empty()) return 0;
  const double coarsest = *std::ranges::max_element(sample_m);
  return std::isinf(coarsest) ? 0 : coarsest;
}

EoManager::EoManager(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      frame_(parse_runway(values.get<std::string>("Runway")).threshold),
      ground_(ground_of(values)),
      random_(values.find<std::uint64_t>("Seed").value_or(1)),
      flight_(entity, topic::kFlightState),
      truth_(entity, topic::kTruth),
      elements_(entity, topic::kElements, skein::TopicQos::state()),
      images_(entity.publisher<recon::Images>(topic::kImages.name)),
      truths_(entity.publisher<recon::ObjectTruths>(topic::kObjects.name)),
      member_(entity, values, [this](Tick tick) { work(tick); }) {
  for (const ObjectText& each : parse_objects(values.find<std::string>("Objects").value_or(""))) {
    objects_.push_back({frame_.to_local(each.place), each.size_m, each.legs, -kNever});
  }
}

void EoManager::work(Tick tick) {
  recon::Images taken{tick, position(frame_, Local{}), {}};
  const auto state = flight_.at(tick);
  const auto truth = truth_.at(tick);
  // Of the second before: who chooses them waits for these images.
  const auto list = elements_.at(tick - 1);
  const double now_s = seconds_of(tick);
  if (collection_ && now_s > collection_->begin_s + collection_->plan.seconds) collection_.reset();
  const recon::Element* next =
      !list || list->next < 0 ? nullptr : &list->elements.at(static_cast<std::size_t>(list->next));
  const bool watches = next && next->found;
  const bool waits = !collection_ || now_s < collection_->begin_s;
  if (state && watches && is_due(topic::kElements.period, tick)) {
    watch(now_s, seconds_of(list->tick), *state, *next);
  } else if (state && list && waits && is_due(topic::kElements.period, tick)) {
    // What is planned stays in a gust, and when it is too late to plan it anew.
    if (collection_ && (!next || next->name != collection_->element)) collection_.reset();
    if (next) prepare(now_s, *state, *next);
  }
  if (state && truth && collection_) {
    if (auto image = take(now_s, *state, *truth)) taken.images.push_back(std::move(*image));
  }
  images_.publish(taken);
  if (is_due(topic::kObjects.period, tick)) tell_truth(tick);
}

/// Stays with a target that was found, wherever the aircraft flies.
void EoManager::watch(double now_s, double known_s, const recon::FlightState& state,
                      const recon::Element& element) {
  const Local aircraft = local(frame_, state.position);
  Local place = local(frame_, element.line.front());
  place.north_m += (now_s - known_s) * element.north_m_s;
  place.east_m += (now_s - known_s) * element.east_m_s;
  place = on_ground(ground_, place);
  recon::CollectionTask task;
  task.line = {local_place(place)};
  task.height_m = aircraft.height_m - place.height_m;
  task.offset_m = map_distance_m(place, aircraft);
  task.ground_speed_m_s = std::hypot(state.north_m_s, state.east_m_s);
  task.course_rad = std::atan2(state.east_m_s, state.north_m_s);
  task.watched = true;
  task.north_m_s = element.north_m_s;
  task.east_m_s = element.east_m_s;
  if (const auto plan = ask_plan(task, element)) collection_ = {element.name, *plan, now_s};
}

/// Plans the collection of an element that the present flight leads past.
void EoManager::prepare(double now_s, const recon::FlightState& state,
                        const recon::Element& element) {
  const Local aircraft = local(frame_, state.position);
  const double course_rad = std::atan2(state.east_m_s, state.north_m_s);
  const double speed_m_s = std::hypot(state.north_m_s, state.east_m_s);
  std::vector<Local> line = line_of(element);
  const Local middle = middle_of(line);
  const Passage pass = passage(aircraft, course_rad, middle);
  const double abeam_s = pass.ahead_m / std::max(speed_m_s, 1.0);
  if (std::abs(state.bank_rad) > kLevel_rad || !is_ahead(pass) || abeam_s > kAhead_s ||
      !put_along(line, course_rad))
    return;
  recon::CollectionTask task;
  for (const Local& each : line) task.line.push_back(local_place(each));
  task.margin_m = element.margin_m;
  task.height_m = aircraft.height_m - middle.height_m;
  task.offset_m = std::abs(pass.offset_m);
  task.ground_speed_m_s = speed_m_s;
  task.course_rad = course_rad;
  const auto plan = ask_plan(task, element);
  if (!plan) return;
  Seen& seen = seen_[element.name];
  if (seen.line != element.line) {
    seen = {element.line, {}, {}};
    for (const Local& part : parts_of_line(line, kParts_m))
      seen.parts.push_back(on_ground(ground_, part));
    seen.sample_m.assign(seen.parts.size(), kNever);
  }
  collection_ = Collection{element.name, *plan, now_s + std::max(0.0, abeam_s - plan->early_s)};
}

std::optional<recon::CollectionPlan> EoManager::ask_plan(const recon::CollectionTask& task,
                                                         const recon::Element& element) {
  skein::Task<recon::ICollectionPattern, recon::CollectionPlan> wanted;
  wanted.request = (task.watched ? "watch " : "collect ") + element.name;
  wanted.features = {{"height_m", task.height_m}, {"offset_m", task.offset_m}};
  wanted.execution = skein::Execution::All;
  wanted.enough = skein::TaskOptions::kAll;
  wanted.run = [&](recon::ICollectionPattern::Proxy& pattern, skein::Duration) {
    return pattern.async_plan(task);
  };
  // A pattern is not at fault for what its objective is.
  wanted.evaluate.admitted(
      "shows", [&](const recon::CollectionPlan& plan) -> std::optional<std::string> {
        if (plan.coverage < kLeastCoverage)
          return fmt::format("it shows {:.0f} % of the element", 100 * plan.coverage);
        if (!task.watched && plan.ground_sample_m > kCoarsest * element.wanted_ground_sample_m)
          return fmt::format("it shows {:.2f} m a pixel, where {:.2f} are wanted",
                             plan.ground_sample_m, element.wanted_ground_sample_m);
        return std::nullopt;
      });
  wanted.synthesis = by_names(skein::best_by_cost<recon::CollectionPlan>(
      [sample_m = element.wanted_ground_sample_m](const recon::CollectionPlan& plan) {
        return collection_cost(
            {{}, plan.seconds, plan.early_s, plan.coverage, plan.ground_sample_m}, sample_m);
      }));
  return decide(entity_, wanted);
}

/// The gimbal is pointed by what the aircraft believes of itself; what the image shows is by where
/// it truly is.
std::optional<recon::Image> EoManager::take(double now_s, const recon::FlightState& state,
                                            const recon::Truth& truth) {
  const double time_s = now_s - collection_->begin_s;
  const recon::CameraPointing* pointing = pointing_at(collection_->plan, time_s);
  if (!pointing) return std::nullopt;
  const Attitude believed{state.bank_rad, std::atan2(state.up_m_s, state.airspeed_m_s),
                          state.heading_rad};
  // Between the ends of a road there may be hills.
  const Local aim = on_ground(ground_, aim_of(*pointing, time_s));
  const GimbalAngles gimbal = point_at(local(frame_, state.position), believed, aim);
  const CameraPose pose{
      local(frame_, truth.position), {truth.bank_rad, truth.climb_rad, truth.heading_rad}, gimbal};
  const auto shown = footprint(pose, kCamera, ground_);
  const auto sample = ground_sample(pose, kCamera, {}, ground_);
  if (!shown || !sample) return std::nullopt;
  Seen& seen = seen_[collection_->element];
  look_at_parts(pose, seen);
  recon::Image image{collection_->element, truth.position,    {},
                     sample->distance_m(), seen.achieved_m(), {}};
  for (const Local& corner : shown->corners) image.corners.push_back(position(frame_, corner));
  find_objects(now_s, pose, image);
  return image;
}

void EoManager::find_objects(double now_s, const CameraPose& pose, recon::Image& image) {
  std::vector<Object> objects;
  for (TrueObject& each : objects_) {
    objects.push_back({place_of(each, now_s), each.size_m});
    if (ground_sample_of(pose, kCamera, objects.back().place, ground_)) each.shown_s = now_s;
  }
  for (const Detection& each : detect(pose, kCamera, objects, {}, ground_, random_)) {
    const auto& [mean, covariance] = each.position;
    image.found.push_back({mean[0], mean[1], covariance[0], covariance[1], covariance[3]});
  }
}

Local EoManager::place_of(const TrueObject& object, double now_s) const {
  return on_ground(ground_, moved(object.place, object.legs, now_s));
}

void EoManager::tell_truth(Tick tick) const {
  recon::ObjectTruths told{tick, {}};
  const double now_s = seconds_of(tick);
  for (const TrueObject& each : objects_)
    told.objects.push_back(
        {position(frame_, place_of(each, now_s)), now_s - each.shown_s < kShownNow_s});
  truths_.publish(told);
}

void EoManager::look_at_parts(const CameraPose& pose, Seen& seen) const {
  for (std::size_t i = 0; i < seen.parts.size(); ++i) {
    if (const auto sample = ground_sample_of(pose, kCamera, seen.parts[i], ground_))
      seen.sample_m[i] = std::min(seen.sample_m[i], sample->distance_m());
  }
}

/// On the ground.
std::vector<Local> EoManager::line_of(const recon::Element& element) const {
  std::vector<Local> line;
  for (const recon::Position& each : element.line)
    line.push_back(on_ground(ground_, local(frame_, each)));
  return line;
}

}  // namespace reconnaissance
