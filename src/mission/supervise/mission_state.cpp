#include "mission/supervise/mission_state.hpp"

#include <algorithm>

namespace skein::launch {
namespace {

/// The process of a peer, which comes first, and those of its CSPs; empty where it has none here.
std::vector<std::size_t> processes_of(const LaunchPlan& plan, const std::string& peer) {
  std::vector<std::size_t> processes;
  for (std::size_t i = 0; i < plan.children.size(); ++i) {
    if (plan.children[i].name == peer) processes.insert(processes.begin(), i);
    if (plan.children[i].name.starts_with(peer + "/")) processes.push_back(i);
  }
  return processes;
}

}  // namespace

MissionState::MissionState(const LaunchPlan& plan) {
  for (const ChildPlan& child : plan.children) {
    Role role{child.runs_mission, child.rules.on_loss, child.layer, {}};
    for (const Prerequisite& prerequisite : child.after) {
      auto& alternatives = role.after.emplace_back();
      for (const std::string& provider : prerequisite.providers) {
        auto processes = processes_of(plan, provider);
        const bool earlier = std::all_of(processes.begin(), processes.end(), [&](std::size_t i) {
          return plan.children[i].layer < child.layer;
        });
        if (!processes.empty() && earlier) alternatives.push_back(std::move(processes));
      }
    }
    roles_.push_back(std::move(role));
    machines_.emplace_back(child.rules);
  }
}

bool MissionState::is_settled(const std::vector<std::size_t>& peer) const {
  return machines_[peer.front()].state() == ChildState::Ready &&
         std::all_of(peer.begin(), peer.end(), [&](std::size_t i) {
           return machines_[i].state() == ChildState::Ready || machines_[i].is_final();
         });
}

bool MissionState::may_start(std::size_t child) const {
  const auto& after = roles_[child].after;
  return std::all_of(after.begin(), after.end(), [&](const auto& providers) {
    const bool hopeless = std::all_of(providers.begin(), providers.end(), [&](const auto& peer) {
      return machines_[peer.front()].is_final();
    });
    return hopeless || std::any_of(providers.begin(), providers.end(),
                                   [&](const auto& peer) { return is_settled(peer); });
  });
}

void MissionState::start_what_may(Time now, Steps& steps) {
  for (std::size_t i = 0; i < machines_.size(); ++i) {
    if (machines_[i].state() == ChildState::Idle && may_start(i))
      steps.push_back({i, machines_[i].start(now)});
  }
}

void MissionState::end(Verdict verdict, Time now, Steps& steps) {
  verdict_ = verdict;
  for (std::size_t i = 0; i < machines_.size(); ++i) steps.push_back({i, machines_[i].stop(now)});
}

void MissionState::judge_loss(std::size_t child, Time now, Steps& steps, bool misconfigured) {
  if (verdict_ || machines_[child].state() != ChildState::Lost) return;
  const Role& role = roles_[child];
  // It was never there: a profile that is wrong is told, and not flown without it.
  const bool never_began = misconfigured && !machines_[child].was_ready() &&
                           role.on_loss != profile::LossPolicy::Continue;
  if (role.runs_mission || role.on_loss == profile::LossPolicy::Abort || never_began)
    end({End::Lost, child}, now, steps);
  degraded_ = degraded_ || role.on_loss == profile::LossPolicy::Degrade;
}

/// What follows from any event.
void MissionState::follow(Time now, Steps& steps) {
  if (started_ && !verdict_) start_what_may(now, steps);
  if (!verdict_ && all_final()) verdict_ = Verdict{End::AllEnded};
  std::erase_if(steps, [](const Step& step) { return step.action == ChildAction::None; });
}

MissionState::Steps MissionState::start(Time now) {
  Steps steps;
  started_ = true;
  follow(now, steps);
  return steps;
}

MissionState::Steps MissionState::ready(std::size_t child, Time now) {
  Steps steps{{child, machines_[child].ready(now)}};
  follow(now, steps);
  return steps;
}

MissionState::Steps MissionState::progress(std::size_t child, Time now) {
  Steps steps{{child, machines_[child].progress(now)}};
  follow(now, steps);
  return steps;
}

MissionState::Steps MissionState::exited(std::size_t child, bool failed, Time now,
                                         bool misconfigured) {
  const auto& machine = machines_[child];
  Steps steps{{child, machines_[child].exited(failed, now, misconfigured)}};
  if (!verdict_ && roles_[child].runs_mission && machine.is_final() && machine.hang() == Hang::None)
    end({End::MissionEnded, child}, now, steps);
  judge_loss(child, now, steps, misconfigured);
  follow(now, steps);
  return steps;
}

MissionState::Steps MissionState::spawn_failed(std::size_t child, bool passing, Time now) {
  Steps steps{{child, machines_[child].spawn_failed(passing, now)}};
  judge_loss(child, now, steps);
  follow(now, steps);
  return steps;
}

MissionState::Steps MissionState::stop(Time now) {
  Steps steps;
  end(verdict_.value_or(Verdict{End::Stopped}), now, steps);
  follow(now, steps);
  return steps;
}

MissionState::Steps MissionState::restart(std::size_t child, Time now) {
  Steps steps;
  if (!verdict_) steps.push_back({child, machines_[child].restart(now)});
  follow(now, steps);
  return steps;
}

MissionState::Steps MissionState::tick(Time now) {
  Steps steps;
  for (std::size_t i = 0; i < machines_.size(); ++i) steps.push_back({i, machines_[i].tick(now)});
  follow(now, steps);
  return steps;
}

std::optional<Time> MissionState::next_tick() const {
  std::optional<Time> due;
  for (const auto& machine : machines_) {
    if (const auto tick = machine.next_tick()) due = due ? std::min(*due, *tick) : *tick;
  }
  return due;
}

bool MissionState::all_settled() const {
  return std::all_of(machines_.begin(), machines_.end(), [](const auto& machine) {
    return machine.state() == ChildState::Ready || machine.is_final();
  });
}

std::size_t MissionState::ready_count() const {
  return static_cast<std::size_t>(
      std::count_if(machines_.begin(), machines_.end(),
                    [](const auto& machine) { return machine.state() == ChildState::Ready; }));
}

bool MissionState::all_final() const {
  return std::all_of(machines_.begin(), machines_.end(),
                     [](const auto& machine) { return machine.is_final(); });
}

}  // namespace skein::launch
