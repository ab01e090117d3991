#pragma once

#include <map>
#include <string>
#include <vector>

#include "ticks.hpp"

namespace reconnaissance {

/// What a participant tells of itself: once when it joins, after each tick in which it takes part,
/// and again whenever it has said nothing for a while.
struct Told {
  std::string participant;
  std::uint64_t life = 0;  ///< Another number when its process has started anew.
  int period = 1;          ///< In ticks.
  Tick done = -1;          ///< The last tick whose work is done; -1: none.
  bool leaves = false;
};

/// Who takes part in the mission's time, and whether it may advance: when all that are due at the
/// present tick have acknowledged it. A pure object: what happened goes in; no clock, no thread, no
/// network.
class LockStep {
 public:
  /// Time begins when that many take part.
  explicit LockStep(std::size_t expected) : expected_(expected) {}

  /// A participant has spoken. One that is new, or has started anew, joins at the present tick, and
  /// is due at the next one that its period divides.
  void hear(const Told& told);

  /// Looks whether anybody is gone. Of the participants only so many are still connected: the
  /// others, those that have been silent longest, are out, if that was for `patience` looks or
  /// more. Looks count, not time: a keeper that was stopped has heard nobody, and nobody is gone.
  /// Returns their names.
  std::vector<std::string> keep_connected(std::size_t connected, int patience);

  /// -1 before the beginning.
  Tick tick() const { return tick_; }

  /// Whether the next tick may begin.
  bool may_advance() const;

  /// Begins it.
  void advance() { ++tick_; }

  /// Those for which the present tick still waits.
  std::vector<std::string> awaited() const;

  std::size_t participants() const { return participants_.size(); }

 private:
  struct Participant {
    std::uint64_t life = 0;
    int period = 1;
    Tick joined = -1;
    Tick done = -1;
    int looks = 0;  // since it was heard
  };

  bool owes(const Participant& participant) const;

  std::size_t expected_;
  Tick tick_ = -1;
  std::map<std::string, Participant> participants_;
};

}  // namespace reconnaissance
