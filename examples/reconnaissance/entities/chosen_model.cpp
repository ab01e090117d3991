#include "chosen_model.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "deciding.hpp"
#include "skein/component_registry.hpp"
#include "skein/error.hpp"

namespace reconnaissance {
namespace {

using namespace std::chrono_literals;

// For how long the mission's time waits for one that is lost: a launcher has started it again long
// before, unless the machine is very busy.
constexpr auto kAbsence = 5s;
constexpr auto kLookAgain = 20ms;
// How often the best is looked for while another one flies.
constexpr auto kLookForBest = 1s;

}  // namespace

ChosenModel::ChosenModel(skein::Entity& entity, std::vector<std::string> names)
    : entity_(entity), names_(std::move(names)) {
  if (names_.empty()) names_.emplace_back();
}

void ChosenModel::place(const recon::ModelState& state, const std::stop_token& stop) {
  state_ = state;
  choose(stop);
}

recon::ModelState ChosenModel::advance(const recon::ModelInput& input,
                                       const std::stop_token& stop) {
  if (!model_) choose(stop);
  look_for_best();
  for (;;) {
    const skein::Instant began = entity_.clock().now();
    const std::string name = names_.at(flies_);
    std::string reason;
    bool refused = false;
    try {
      state_ = model_->advance(input);
      return state_;
    } catch (const recon::Refused& refusal) {
      reason = refusal.reason;
      refused = true;
    } catch (const skein::Error& error) {
      reason = error.what();
    }
    fmt::print(stderr, "{} is lost: {}\n", name, reason);
    // What flies on must fly: with another one, if there is one.
    if (refused && names_.size() > 1) names_.erase(names_.begin() + static_cast<long>(flies_));
    choose(stop);
    const std::chrono::duration<double> took = entity_.clock().now() - began;
    fmt::print(stderr, "{} flies on from the last state, {:.2f} s later\n", names_[flies_],
               took.count());
  }
}

void ChosenModel::choose(const std::stop_token& stop) {
  std::string reasons;
  for (flies_ = 0; flies_ < names_.size();) {
    const std::string name = names_[flies_];
    const auto absence = await(name, stop);
    if (!absence) return;
    fmt::print(stderr, "{} does not fly: {}\n", name, absence->reason);
    reasons += (reasons.empty() ? "" : "; ") + absence->reason;
    if (absence->lost || names_.size() == 1) {
      ++flies_;
    } else {
      names_.erase(names_.begin() + static_cast<long>(flies_));
    }
  }
  flies_ = 0;
  throw skein::Unavailable("no flight model flies: " + reasons);
}

std::optional<ChosenModel::Absence> ChosenModel::await(const std::string& name,
                                                       const std::stop_token& stop) {
  const skein::Instant until = entity_.clock().now() + kAbsence;
  for (;;) {
    auto absence = try_to_place(name);
    if (!absence || !absence->lost || entity_.clock().now() >= until) return absence;
    if (skein::await_end(entity_, stop, kLookAgain)) return absence;
  }
}

std::optional<ChosenModel::Absence> ChosenModel::try_to_place(const std::string& name) {
  std::optional<recon::IFlightModel::Proxy> placed;
  skein::Task<recon::IFlightModel, bool> task;
  task.request = "who flies";
  task.only = name;
  task.run = [&](recon::IFlightModel::Proxy& model, skein::Duration) {
    model.place(state_);
    placed = model;
    return true;
  };
  try {
    entity_.head().perform(task, nullptr, kUnlessItHangs);
  } catch (const recon::Refused& refusal) {
    return Absence{refusal.reason, false};
  } catch (const skein::Error& error) {
    return Absence{error.what()};
  }
  model_ = placed;
  return std::nullopt;
}

void ChosenModel::look_for_best() {
  const skein::Instant now = entity_.clock().now();
  if (flies_ == 0 || now < look_at_) return;
  look_at_ = now + kLookForBest;
  if (try_to_place(names_.front())) return;
  flies_ = 0;
  fmt::print(stderr, "{} flies again\n", names_.front());
}

}  // namespace reconnaissance
