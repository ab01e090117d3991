#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mission/supervise/child_state.hpp"
#include "mission/supervise/launch_plan.hpp"

namespace skein::launch {

/// The life of a whole mission on this host: what happens to its processes in, what has to be done
/// out. As ChildStateMachine, which it has one of for each child, it knows no process and no clock.
///
/// A child is started as soon as what its plan wants ready before it (ChildPlan::after) is. A peer
/// counts as ready when its process is, and each CSP process of it is or has ended for good. Only
/// what is of an earlier layer is waited for, and only as long as it may still become ready. So no
/// child waits for one that has ended, and none for itself.
///
/// The first of these ends the mission, and stops all that still runs: the peer that runs the
/// mission ended; a child was lost that must not be (LossPolicy::Abort, or one but
/// LossPolicy::Continue that ended misconfigured and was never ready); stop() was called; all
/// children have ended.
class MissionState {
 public:
  struct Step {
    std::size_t child;
    ChildAction action;
  };
  /// In the order in which they are to be done.
  using Steps = std::vector<Step>;

  enum class End {
    MissionEnded,  ///< The peer that runs the mission ended by itself.
    Lost,          ///< A child was lost that must not be.
    Stopped,       ///< stop() was called.
    AllEnded,      ///< Every child has ended for good.
  };
  struct Verdict {
    End end;
    std::size_t child = 0;  ///< Whose end it was; of no meaning for the others.
  };

  explicit MissionState(const LaunchPlan& plan);

  Steps start(Time now);
  Steps ready(std::size_t child, Time now);
  Steps progress(std::size_t child, Time now);
  Steps exited(std::size_t child, bool failed, Time now, bool misconfigured = false);
  Steps spawn_failed(std::size_t child, bool passing, Time now);
  /// Asked a second time, and after any other end: kills at once.
  Steps stop(Time now);
  /// See ChildStateMachine::restart(). Nothing once the mission ends.
  Steps restart(std::size_t child, Time now);
  Steps tick(Time now);
  std::optional<Time> next_tick() const;

  const ChildStateMachine& child(std::size_t number) const { return machines_[number]; }
  /// The first cause of the mission's end; nothing as long as it goes on.
  const std::optional<Verdict>& verdict() const noexcept { return verdict_; }
  /// Whether no child is awaited any more: each is ready, or has ended for good.
  bool all_settled() const;
  std::size_t ready_count() const;
  bool all_final() const;
  /// Whether a child was lost without which the mission is degraded.
  bool is_degraded() const noexcept { return degraded_; }

 private:
  struct Role {
    bool runs_mission;
    profile::LossPolicy on_loss;
    std::size_t layer;
    /// For each prerequisite the peers that provide it, each as its process and those of its CSPs.
    std::vector<std::vector<std::vector<std::size_t>>> after;
  };

  bool is_settled(const std::vector<std::size_t>& peer) const;
  bool may_start(std::size_t child) const;
  void start_what_may(Time now, Steps& steps);
  void judge_loss(std::size_t child, Time now, Steps& steps, bool misconfigured = false);
  void end(Verdict verdict, Time now, Steps& steps);
  void follow(Time now, Steps& steps);

  std::vector<Role> roles_;
  std::vector<ChildStateMachine> machines_;
  std::optional<Verdict> verdict_;
  bool started_ = false;
  bool degraded_ = false;
};

}  // namespace skein::launch
