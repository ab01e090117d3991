#include "rpc/service/call_intake.hpp"

#include <string>
#include <utility>

#include "rpc/service/service_owner.hpp"
#include "skein/error.hpp"

namespace skein::rpc {

// Accepted under the lock: an invocation that comes before the end is in the queue when close()
// empties it. Uncounted without the lock, since whoever waits for that holds one of its own.
void CallIntake::add(std::shared_ptr<Invocation> invocation, bool answered_later) {
  try {
    std::lock_guard lock(mutex_);
    if (!calls_.accept()) throw being_withdrawn(service_);
    if (!queue_.has_room(invocation->connection)) {
      throw Overloaded("the queue of " + std::string(service_) +
                       " is full; the call was not executed");
    }
    if (answered_later && !owed_.has_room(invocation->connection)) {
      throw Overloaded(std::string(service_) +
                       " owes as many answers as it may; the call was not executed");
    }
    queue_.push(std::move(invocation));
  } catch (...) {
    calls_.note_done();
    throw;
  }
}

std::shared_ptr<Invocation> CallIntake::take() {
  std::lock_guard lock(mutex_);
  return queue_.pop();
}

std::size_t CallIntake::size() const {
  std::lock_guard lock(mutex_);
  return queue_.size();
}

}  // namespace skein::rpc
