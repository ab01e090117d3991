#include "link.hpp"

#include <utility>

namespace skein::same_host {

bool Ending::set(std::function<void()> action) {
  std::lock_guard lock(mutex_);
  if (over_) return false;
  action_ = std::move(action);
  return true;
}

void Ending::forget() {
  std::lock_guard lock(mutex_);
  action_ = nullptr;
}

void Ending::run() {
  std::lock_guard lock(mutex_);
  if (std::exchange(over_, true) || !action_) return;
  action_();
}

Link::Link(Side side, std::shared_ptr<const FileDescriptor> socket, SharedMemory memory,
           DoorbellPair doorbells, const Guid& own, const Guid& peer, std::function<void()> notify)
    : LinkState(side, std::move(socket), std::move(memory), std::move(doorbells),
                [this, notify = std::move(notify)] {
                  out_.note_end();
                  notify();
                }),
      own_(own),
      peer_(peer) {}

}  // namespace skein::same_host
