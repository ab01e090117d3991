#include "member.hpp"

#include <utility>

#include "in_system.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

constexpr int kHealthPeriod = 50;

}  // namespace

HealthReport::HealthReport(skein::Entity& entity, const std::vector<std::string>& systems)
    : health_{.entity = entity.options().name},
      publisher_(entity.publisher<recon::Health>(topic::kHealth,
                                                 in_systems(systems, skein::TopicQos::state()))) {}

void HealthReport::set(recon::Condition condition, const std::string& reason) {
  std::lock_guard lock(mutex_);
  health_.condition = condition;
  health_.reason = reason;
}

void HealthReport::tell(Tick tick, const std::string& failure) {
  if (!is_due(kHealthPeriod, tick)) return;
  recon::Health health;
  {
    std::lock_guard lock(mutex_);
    health = health_;
  }
  health.tick = tick;
  if (!failure.empty()) {
    health.condition = recon::Condition::Failed;
    health.reason = failure;
  }
  publisher_.publish(health);
}

Member::Member(skein::Entity& entity, const skein::ParameterValues& values, Participant::Work work,
               const std::vector<std::string>& systems)
    : health_(entity, systems),
      participant_(entity, values.get<int>("Rate"), [this, work = std::move(work)](Tick tick) {
        const std::string failure = participant_.failure();
        if (work) work(tick);
        health_.tell(tick, failure);
      }) {}

}  // namespace reconnaissance
