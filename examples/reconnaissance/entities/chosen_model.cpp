#include "chosen_model.hpp"

#include <fmt/format.h>

#include <algorithm>
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
  for (const std::string& each : choose(stop)) fmt::print(stderr, "{}\n", each);
}

recon::ModelState ChosenModel::advance(const recon::ModelInput& input,
                                       const std::stop_token& stop) {
  if (!model_) place(state_, stop);
  look_for_best();
  for (;;) {
    const skein::Instant began = entity_.clock().now();
    const std::string name = names_.at(flies_);
    std::string reason;
    bool refused = false;
    try {
      const std::uint32_t replaced = state_.replaced;
      state_ = model_->advance(input);
      lost_ += state_.replaced - std::min(replaced, state_.replaced);
      return state_;
    } catch (const recon::Refused& refusal) {
      reason = refusal.reason;
      refused = true;
    } catch (const skein::Error& error) {
      reason = error.what();
    }
    ++lost_;
    state_.replaced = 0;
    // What flies on must fly: with another one, if there is one.
    if (refused && names_.size() > 1) names_.erase(names_.begin() + static_cast<long>(flies_));
    const std::vector<std::string> absent = choose(stop);
    const std::chrono::duration<double> took = entity_.clock().now() - began;
    // Not before: where the flight ends, none flies on.
    fmt::print(stderr, "{} is lost: {}\n", name, reason);
    for (const std::string& each : absent) fmt::print(stderr, "{}\n", each);
    fmt::print(stderr, "{} flies on from the last state, {:.2f} s later\n", names_[flies_],
               took.count());
  }
}

std::vector<std::string> ChosenModel::choose(const std::stop_token& stop) {
  std::vector<std::string> absent;
  for (flies_ = 0; flies_ < names_.size();) {
    const std::string name = names_[flies_];
    const auto absence = await(name, stop);
    if (!absence) return absent;
    absent.push_back(fmt::format("{} does not fly: {}", name, absence->reason));
    if (absence->lost || names_.size() == 1) {
      ++flies_;
    } else {
      names_.erase(names_.begin() + static_cast<long>(flies_));
    }
  }
  flies_ = 0;
  throw skein::Unavailable(fmt::format("{}", fmt::join(absent, "; ")));
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
    perform(entity_, task);
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
