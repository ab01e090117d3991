#include "link.hpp"

#include <sys/socket.h>

#include <utility>

#include "dds/largest_sample.hpp"

namespace skein::same_host {
namespace {

// A message that needed more is not kept for the next one.
constexpr std::size_t kKeptCapacity = 4 << 20;

RingPlace place_of(const SharedMemory& memory, bool requests) {
  const std::size_t which = requests ? 0 : 1;
  return {reinterpret_cast<RingState*>(memory.data()) + which,
          memory.data() + (Link::kMemory - 2 * Link::kCapacity) + which * Link::kCapacity,
          Link::kCapacity};
}

}  // namespace

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
           const Guid& own, const Guid& peer, std::function<void()> notify)
    : socket_(std::move(socket)),
      memory_(std::move(memory)),
      own_(own),
      peer_(peer),
      in_(place_of(memory_, side == Side::Provider), dds::kLargestSample),
      notify_(std::move(notify)),
      out_(place_of(memory_, side == Side::Client)) {}

Link::Sent Link::send(std::span<const std::byte> message, Duration patience) {
  std::lock_guard lock(out_mutex_);
  if (ended_) return Sent::Ended;
  try {
    if (out_.write(message, patience, [this] { return ended(); })) return Sent::Yes;
  } catch (const BrokenRing&) {
    break_off();
    throw;
  }
  return ended_ ? Sent::Ended : Sent::NoRoom;
}

bool Link::await_taken(Instant deadline) {
  std::lock_guard lock(out_mutex_);
  try {
    return out_.await_empty(deadline, [this] { return ended(); });
  } catch (const BrokenRing&) {
    break_off();
    return false;
  }
}

std::optional<std::span<const std::byte>> Link::receive(Bytes& spare) {
  if (message_.empty()) message_.swap(spare);
  try {
    if (in_.take(message_)) return std::span<const std::byte>(message_);
  } catch (const BrokenRing&) {
    break_off();
    throw;
  }
  if (message_.empty()) message_.swap(spare);
  if (unfinished_ != message_.size()) unfinished_ = message_.size();
  return std::nullopt;
}

void Link::break_off() {
  broken_ = true;
  close();
}

void Link::release(Bytes& spare) {
  message_.clear();
  if (unfinished_ != 0) unfinished_ = 0;
  if (message_.capacity() > kKeptCapacity) message_ = Bytes();
  spare = std::move(message_);
}

void Link::close() {
  shutdown(socket_->get(), SHUT_RDWR);
  note_end();
}

void Link::note_end() {
  if (ended_.exchange(true)) return;
  out_.wake();
  notify_();
}

}  // namespace skein::same_host
