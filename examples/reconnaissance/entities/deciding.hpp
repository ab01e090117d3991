#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"

namespace reconnaissance {

/// While a Head decides in a tick, the mission's time stands, so that no time limit of the mission
/// could end it. This one, by the system's clock, is for CSPs that hang: so long that no busy
/// machine decides anything, and the Head asks the next one in time.
inline constexpr skein::Duration kUnlessItHangs = std::chrono::seconds(20);
/// Of a call to an entity whose Head decides several times, or whose process is stopped for a
/// minute; less than the mission's time waits for the caller.
inline constexpr skein::Duration kUnlessAllHang = std::chrono::seconds(80);

/// What the Head makes of a task. Tries anew where the time ran out, as it does when this process
/// is stopped meanwhile: its CSPs of other processes are found again soon.
template <class Interface, class Result>
Result perform(skein::Entity& entity, const skein::Task<Interface, Result>& task,
               skein::introspection::Decision* record = nullptr) {
  const auto now = [&] { return entity.clock().now(); };
  const skein::Instant in_time = now() + kUnlessItHangs;
  std::optional<skein::Instant> anew_until;
  for (;;) {
    try {
      return entity.head().perform(task, record, kUnlessItHangs);
    } catch (const skein::Error&) {
      if (now() < in_time) throw;
      if (!anew_until) anew_until = now() + kUnlessItHangs;
      if (now() >= *anew_until) throw;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// What the Head makes of a task; nothing if no CSP has an answer, or they do not agree. Throws
/// what else ends a task.
template <class Interface, class Result>
std::optional<Result> decide(skein::Entity& entity, const skein::Task<Interface, Result>& task) {
  try {
    return perform(entity, task);
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
