#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "skein/entity.hpp"
#include "skein/head.hpp"

namespace reconnaissance {

/// While a Head decides in a tick, the mission's time stands, so that no time limit of the mission
/// could end it. This one, by the system's clock, is for CSPs that hang: so long that no busy
/// machine decides anything, and the Head asks the next one in time.
inline constexpr skein::Duration kUnlessItHangs = std::chrono::seconds(20);
/// Of who asks somebody whose Head decides several times.
inline constexpr skein::Duration kUnlessAllHang = std::chrono::minutes(1);

/// What the Head makes of a task; nothing if no CSP has an answer, or they do not agree. Throws
/// what else ends a task.
template <class Interface, class Result>
std::optional<Result> decide(skein::Entity& entity, const skein::Task<Interface, Result>& task) {
  try {
    return entity.head().perform(task, nullptr, kUnlessItHangs);
  } catch (const skein::UserException&) {
  } catch (const skein::NoneAccepted&) {
  }
  return std::nullopt;
}

/// A synthesis to which it does not matter whose result came first: a mission decides the same in
/// each run.
template <class Result>
skein::Synthesis<Result> by_names(skein::Synthesis<Result> synthesis) {
  return [synthesis = std::move(synthesis)](std::vector<skein::Opinion<Result>> opinions) {
    std::ranges::sort(opinions, {}, &skein::Opinion<Result>::csp);
    return synthesis(opinions);
  };
}

}  // namespace reconnaissance
