#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "received_link.hpp"
#include "skein/clock.hpp"
#include "spin_policy.hpp"

namespace skein::same_host {

/// The links of a receiver as the thread that leads sees them: it looks at those that have brought
/// something of late, *attended* ones, and hears of the others by their doorbells. For one thread
/// at a time.
class LedLinks {
 public:
  using Links = std::vector<std::shared_ptr<ReceivedLink>>;

  /// `spin` as SpinPolicy's limit.
  LedLinks(std::shared_ptr<ReceiverNews> news, Duration spin)
      : news_(std::move(news)), spin_(spin) {}

  /// This thread begins to lead.
  void begin();
  /// `added` are new; others are over, have ended, or were taken back.
  void take_in(const Links& added);
  /// Takes some messages of each link that has some. Once replaced, this may be gone.
  ReceivedLink::Looked look(Taker& taker);
  /// Attends the links of doorbells that rang. Returns whether any rang.
  bool listen() { return attend_rung(std::chrono::milliseconds(0)); }
  /// Clients that have been let sleep.
  void wake_peers() const;
  /// Returns once a link has something, or there is a call at the doorbells.
  void await();

 private:
  void attend(const std::shared_ptr<ReceivedLink>& link);
  bool attend_rung(std::optional<std::chrono::milliseconds> longest);
  bool may_sleep();
  void sleep();
  void take_back_paused();

  const std::shared_ptr<ReceiverNews> news_;
  std::map<std::uint64_t, std::shared_ptr<ReceivedLink>> all_;
  Links attended_;  // of those: the others' doorbells ring
  int turns_ = 0;   // since the doorbells were last listened to
  Instant look_at_paused_ = Instant::max();
  SpinPolicy spin_;
  Bytes spare_;
};

}  // namespace skein::same_host
