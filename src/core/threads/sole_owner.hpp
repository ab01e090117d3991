#pragma once

#include <chrono>
#include <memory>
#include <thread>

namespace skein {

/// Waits until nobody else holds `state`. Timers' actions and tasks reach it by a weak pointer, and
/// hold it while they run. To cancel the last timer is not enough: the action that set it may not
/// have returned yet, and would use, or even destroy, what its owner's end leaves behind. Not from
/// such an action or task.
template <class State>
void await_sole_owner(const std::shared_ptr<State>& state) {
  while (state.use_count() > 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace skein
