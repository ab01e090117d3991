#include "rpc/service/invocation.hpp"

#include <utility>

namespace skein::rpc {

void Invocation::on_cancel(Action action) {
  {
    std::lock_guard lock(action_mutex_);
    if (!cancelled) {
      action_ = std::move(action);
      return;
    }
  }
  if (action) action();
}

void Invocation::tell_cancelled() {
  Action action;
  {
    std::lock_guard lock(action_mutex_);
    action = std::move(action_);
  }
  if (action) action();
}

}  // namespace skein::rpc
