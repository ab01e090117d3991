#include "active_requests.hpp"

#include <utility>
#include <vector>

namespace skein::rpc {

void ActiveRequests::add(const RequestId& id, const std::shared_ptr<Invocation>& invocation) {
  std::lock_guard lock(mutex_);
  all_.emplace(id, invocation);
}

void ActiveRequests::remove(const RequestId& id, const Invocation& call) {
  std::shared_ptr<Invocation> removed;  // goes unlocked
  std::lock_guard lock(mutex_);
  const auto found = all_.find(id);
  if (found == all_.end() || found->second.get() != &call) return;
  removed = std::move(found->second);
  all_.erase(found);
}

std::shared_ptr<Invocation> ActiveRequests::find(const RequestId& id) const {
  std::lock_guard lock(mutex_);
  const auto found = all_.find(id);
  return found == all_.end() ? nullptr : found->second;
}

std::size_t ActiveRequests::size() const {
  std::lock_guard lock(mutex_);
  return all_.size();
}

// Unlocked: an implementation that hears of it may answer at once.
void ActiveRequests::cancel_if(
    const std::function<bool(const RequestId& id, const Invocation& call)>& predicate) const {
  std::vector<std::shared_ptr<Invocation>> cancelled;
  {
    std::lock_guard lock(mutex_);
    for (const auto& [id, call] : all_) {
      if (!call->operation->oneway && predicate(id, *call)) cancelled.push_back(call);
    }
  }
  for (const auto& call : cancelled) call->cancel();
}

}  // namespace skein::rpc
