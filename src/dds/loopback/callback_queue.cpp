#include "callback_queue.hpp"

#include <utility>

namespace skein::dds::loopback {

void CallbackQueue::post(const void* target, Action callback, bool* queued) {
  waiting_.push_back({target, queued, std::move(callback)});
}

void CallbackQueue::run(Lock& lock) {
  if (draining_) return;
  draining_ = true;
  runner_ = std::this_thread::get_id();
  while (!waiting_.empty()) {
    Callback callback = std::move(waiting_.front());
    waiting_.pop_front();
    running_ = callback.target;
    if (callback.queued) *callback.queued = false;
    lock.unlock();
    callback.run();
    callback.run = nullptr;
    lock.lock();
    running_ = nullptr;
    ended_.notify_all();
  }
  draining_ = false;
  runner_ = {};
}

void CallbackQueue::drop(const void* target, Lock& lock) {
  std::erase_if(waiting_, [&](const Callback& callback) { return callback.target == target; });
  if (is_caller()) return;
  ended_.wait(lock, [&] { return running_ != target; });
}

}  // namespace skein::dds::loopback
