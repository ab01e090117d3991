#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "brokerless_discovery/departures.hpp"
#include "skein/selection.hpp"

namespace skein::entity {

/// The CSPs that were lost while they worked on one request, and how long it may wait for one that
/// comes back. Pure: time is an argument. Not thread-safe.
class LostCsps {
 public:
  /// A launcher takes less to start a CSP again.
  static constexpr Duration kReturnPatience = std::chrono::seconds(10);
  /// The Broker may hear of a CSP's end later than its connection does.
  static constexpr Duration kNewsPatience = std::chrono::seconds(1);

  /// `only`: as TaskOptions::only, which outlives this.
  explicit LostCsps(std::string_view only) : only_(only) {}

  void add(const Candidate& candidate, Instant when) {
    losses_.push_back({candidate.name, candidate.provider, when});
  }
  bool empty() const noexcept { return losses_.empty(); }

  /// Whether the CSP was lost so often that it is not asked again: the request may be the cause.
  bool is_worn_out(std::string_view csp) const {
    return std::ranges::count(losses_, csp, &Loss::csp) > 1;
  }

  /// Until when a CSP may come back; in the past if none may. `absent`: as Broker::absent().
  /// `is_known` says whether the Broker still knows a provider.
  Instant awaited(const std::vector<brokerless_discovery::Absence>& absent,
                  const std::function<bool(const Guid&)>& is_known) const {
    Instant until{};
    for (const auto& csp : absent) {
      if (csp.how != brokerless_discovery::Departure::Left && may_come_back(csp.entity))
        until = std::max(until, csp.since + kReturnPatience);
    }
    for (const Loss& loss : losses_) {
      if (may_come_back(loss.csp) && is_known(loss.provider))
        until = std::max(until, loss.when + kNewsPatience);
    }
    return until;
  }

 private:
  struct Loss {
    std::string csp;
    Guid provider;
    Instant when;
  };

  bool may_come_back(std::string_view csp) const {
    return (only_.empty() || csp == only_) && !is_worn_out(csp);
  }

  const std::string_view only_;
  std::vector<Loss> losses_;
};

}  // namespace skein::entity
