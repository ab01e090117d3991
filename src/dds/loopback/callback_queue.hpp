#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <thread>

#include "cores.hpp"
#include "skein/detail/action.hpp"
#include "skein/detail/call_memory.hpp"

namespace skein::dds::loopback {

/// The callbacks of a network, in the order of their events. One runs at a time, outside the
/// network's lock; members are called with it held.
class CallbackQueue {
 public:
  using Lock = std::unique_lock<std::mutex>;

  /// Clears `queued`, which must live as long as the callback, just before that runs; not if it is
  /// dropped.
  void post(const void* target, Action callback, bool* queued = nullptr);

  /// Posts a call of one of the endpoint's listener functions, which may be empty.
  template <class Core, class Function, class... Values>
  void tell(const std::shared_ptr<Core>& endpoint, Function function, Values... values) {
    const EndpointCore* const target = endpoint.get();
    post(target, [endpoint, function, values...] {
      if (const auto& told = endpoint->listener.*function) told(values...);
    });
  }

  /// Runs the callbacks, unless the caller is one or another thread runs them.
  void run(Lock& lock);

  /// Drops the target's callbacks, and waits until none of them runs on another thread.
  void drop(const void* target, Lock& lock);

  /// Whether the calling thread is in a callback.
  bool is_caller() const { return runner_ == std::this_thread::get_id(); }

 private:
  struct Callback {
    const void* target;
    bool* queued;
    Action run;
  };

  std::pmr::deque<Callback> waiting_{&call_memory()};
  const void* running_ = nullptr;
  std::thread::id runner_;
  bool draining_ = false;
  std::condition_variable ended_;
};

}  // namespace skein::dds::loopback
