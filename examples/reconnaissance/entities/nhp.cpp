#include "nhp.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>

#include "mission/places.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

using namespace std::chrono_literals;

constexpr Tick kHealthPeriod = 50;
// What somebody has told in the tick before is on its way here.
constexpr auto kOnTheWay = 250ms;

}  // namespace

Nhp::Nhp(skein::Entity& entity, const skein::ParameterValues& values)
    : crew_(parse_names(values.get<std::string>("Crew"))),
      healths_(entity.subscription<recon::Health>(
          topic::kHealth, skein::TopicQos::state(),
          [this](const recon::Health& health) { hear(health); })),
      mode_(entity.publisher<recon::MissionMode>(topic::kMode.name, skein::TopicQos::state())),
      member_(entity, values, [this](Tick tick) {
        if (is_due(topic::kMode.period, tick)) judge(tick);
      }) {}

void Nhp::hear(const recon::Health& health) {
  {
    std::lock_guard lock(mutex_);
    health_[health.entity] = health;
  }
  heard_.notify_all();
}

/// By what everybody has told before this tick: so it is the same in each run.
void Nhp::judge(Tick tick) {
  recon::MissionMode mode;
  mode.tick = tick;
  mode.mode = recon::Mode::Starting;
  std::unique_lock lock(mutex_);
  if (tick > 0) {
    const Tick wanted = (tick - 1) / kHealthPeriod * kHealthPeriod;
    heard_.wait_for(lock, kOnTheWay, [&] { return all_heard(wanted); });
    for (const std::string& name : crew_) {
      const std::string trouble = trouble_of(name, wanted);
      if (!trouble.empty()) mode.reason += (mode.reason.empty() ? "" : "; ") + name + " " + trouble;
    }
    started_ = started_ || mode.reason.empty();
    if (started_) mode.mode = mode.reason.empty() ? recon::Mode::Normal : recon::Mode::Limited;
  }
  lock.unlock();
  mode_.publish(mode);
}

bool Nhp::all_heard(Tick wanted) const {
  return std::ranges::all_of(crew_, [&](const std::string& name) {
    const auto found = health_.find(name);
    // Who was silent before is not waited for.
    return found == health_.end() || found->second.tick >= wanted ||
           found->second.tick < wanted - kHealthPeriod;
  });
}

std::string Nhp::trouble_of(const std::string& name, Tick wanted) const {
  const auto found = health_.find(name);
  if (found == health_.end()) return "has not been heard of";
  const recon::Health& health = found->second;
  if (health.tick < wanted) {
    const auto last = std::chrono::floor<std::chrono::seconds>(time_of(health.tick));
    return fmt::format("has said nothing since {:%M:%S}", last);
  }
  switch (health.condition) {
    case recon::Condition::Fine:
      return "";
    case recon::Condition::Degraded:
      return "is degraded: " + health.reason;
    case recon::Condition::Failed:
      break;
  }
  return "has failed: " + health.reason;
}

}  // namespace reconnaissance
