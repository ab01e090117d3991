#include "connections.hpp"

#include "core/clock_wait.hpp"
#include "skein/error.hpp"

namespace skein::connector {

Connections::Opening::Opening(Connections& connections) : connections_(connections) {
  std::lock_guard lock(connections_.mutex_);
  connections_.refuse_if_closed();
  ++connections_.openings_;
}

Connections::Opening::~Opening() {
  std::lock_guard lock(connections_.mutex_);
  --connections_.openings_;
  connections_.changed_.notify_all();
}

void Connections::refuse_if_closed() const {
  if (closed_) throw Unavailable("no new connection: this side's entity has ended");
}

void Connections::add(const std::shared_ptr<Channel>& channel) {
  {
    std::lock_guard lock(mutex_);
    channels_.push(channel);
    if (!closed_) return;
  }
  end(*channel);
}

std::vector<ConnectionInfo> Connections::infos() const {
  WeakList<Channel>::List channels;
  {
    std::lock_guard lock(mutex_);
    channels = channels_.all();
  }
  std::vector<ConnectionInfo> all;
  for (const auto& weak : channels) {
    const auto channel = weak.lock();
    if (!channel || !channel->connected()) continue;
    if (const auto info = channel->info()) all.push_back(*info);
  }
  return all;
}

void Connections::pause(Clock& clock, Instant end) {
  std::unique_lock lock(mutex_);
  wait_until(clock, end, lock, changed_, [&] { return closed_.load(); });
}

void Connections::close() {
  WeakList<Channel>::List channels;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    channels = channels_.take_all();
    changed_.notify_all();
  }
  for (const auto& weak : channels) {
    if (const auto channel = weak.lock()) end(*channel);
  }
}

void Connections::await_openings() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return openings_ == 0; });
}

void Connections::end(Channel& channel) {
  channel.lose("this side's entity has ended");
  channel.disconnect();
}

}  // namespace skein::connector
