#include "estimators.hpp"

#include <algorithm>
#include <numeric>
#include <random>

double MeanPower::endurance_min(const battery::Plan& plan) {
  const double total_w = std::accumulate(plan.power_w.begin(), plan.power_w.end(), 0.0);
  return plan.capacity_wh / (total_w / static_cast<double>(plan.power_w.size())) * 60;
}

namespace {

// The last minute's power goes on for as long as the battery lasts.
double discharge_s(const battery::Plan& plan, double wind_factor) {
  constexpr double kLossPerWatt = 1.0 / 5000;  // of the internal resistance
  double left_ws = plan.capacity_wh * 3600;
  double time_s = 0;
  while (left_ws > 0) {
    const auto minute = static_cast<std::size_t>(time_s) / 60;
    const double power_w = plan.power_w[std::min(minute, plan.power_w.size() - 1)] * wind_factor;
    left_ws -= power_w * (1 + power_w * kLossPerWatt);
    time_s += 1;
  }
  return time_s;
}

}  // namespace

double Discharge::endurance_min(const battery::Plan& plan) {
  constexpr std::size_t kGuesses = 1000;
  std::mt19937 random(7);
  std::normal_distribution<double> wind(1.0, 0.1);
  std::vector<double> times_s(kGuesses);
  for (double& time_s : times_s) time_s = discharge_s(plan, std::clamp(wind(random), 0.5, 1.5));
  const auto tenth = times_s.begin() + kGuesses / 10;
  std::nth_element(times_s.begin(), tenth, times_s.end());
  return *tenth / 60;
}
