#include "rpc/client/queued_calls.hpp"

#include <algorithm>
#include <functional>

#include "rpc/wire/conversion.hpp"

namespace skein::rpc {
namespace {

bool is_over(const std::weak_ptr<QueuedCall>& weak) {
  const auto queued = weak.lock();
  return !queued || queued->call->finished();
}

}  // namespace

void QueuedCall::end(const void* out, std::exception_ptr error) {
  clock->cancel(timer);
  if (!call->claim()) return;
  try {
    if (!error && out) convert(*operation->out, out, *call->operation().out, call->out());
    if (!served_as_called()) error = convert(error, call->operation());
  } catch (...) {
    error = std::current_exception();
  }
  note_end(error);
  call->finish(std::move(error));
}

bool QueuedCalls::add(const std::shared_ptr<QueuedCall>& call) {
  std::lock_guard lock(mutex_);
  if (closed_) return false;
  if (calls_.size() >= look_at_) {
    std::erase_if(calls_, is_over);
    look_at_ = std::max<std::size_t>(16, 2 * calls_.size());
  }
  calls_.push_back(call);
  return true;
}

std::size_t QueuedCalls::size() const {
  std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(std::ranges::count_if(calls_, std::not_fn(is_over)));
}

std::vector<std::shared_ptr<QueuedCall>> QueuedCalls::close() {
  std::vector<std::weak_ptr<QueuedCall>> taken;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    taken.swap(calls_);
  }
  std::vector<std::shared_ptr<QueuedCall>> open;
  for (const auto& weak : taken) {
    if (auto call = weak.lock()) open.push_back(std::move(call));
  }
  return open;
}

}  // namespace skein::rpc
