#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

#include "core/recent_set.hpp"

namespace skein::same_host {

/// Notes for the log about clients that a meeting turns away: one for each other user, and one for
/// the first process that wants more than its share. Not thread-safe.
class TurnedAway {
 public:
  void note_stranger(const ucred& who) {
    if (told_users_.contains(who.uid)) return;
    told_users_.insert(who.uid);
    untold_.push_back("process " + std::to_string(who.pid) + " of user " + std::to_string(who.uid) +
                      " is turned away: calls through shared memory are for this entity's user and "
                      "root; further ones of that user are not logged");
  }

  void note_share(pid_t process, std::size_t share) {
    if (std::exchange(told_share_, true)) return;
    untold_.push_back("process " + std::to_string(process) + " wants more than its share of " +
                      std::to_string(share) +
                      " connections through shared memory, and gets the others over DDS; further "
                      "ones like it are not logged");
  }

  /// The notes since the last time. The caller logs them once it has unlocked.
  std::vector<std::string> take() { return std::exchange(untold_, {}); }

 private:
  // Of how many users it is remembered that the log knows of them.
  static constexpr std::size_t kToldUsers = 16;

  RecentSet<uid_t> told_users_{kToldUsers};
  bool told_share_ = false;
  std::vector<std::string> untold_;
};

}  // namespace skein::same_host
