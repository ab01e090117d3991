#include "hub.hpp"

#include "dds/port/sample_format.hpp"

namespace skein::dds::loopback {
namespace {

void put_big_endian(std::uint32_t value, std::uint8_t* to) {
  for (int shift = 24; shift >= 0; shift -= 8) *to++ = static_cast<std::uint8_t>(value >> shift);
}

}  // namespace

WriterCore::WriterCore(const Qos& qos, Hub& hub)
    : history(qos.history_depth),
      deadline(make_deadline_timer(
          qos, [this, &hub](const KeyHash& key) { hub.deadline_missed(guid, key); },
          &hub.clock())) {}

ReaderCore::ReaderCore(const Topic& topic, const Qos& qos, Hub& hub)
    : queue(
          topic.name, qos, {}, [this, &hub](const KeyHash& key) { hub.deadline_missed(guid, key); },
          hub.clock()) {}

Hub::Hub(Clock& clock) : clock_(clock), may_wait_(dynamic_cast<SystemClock*>(&clock) != nullptr) {}

std::shared_ptr<ParticipantCore> Hub::join(const ParticipantOptions& options) {
  Lock lock(mutex_);
  auto participant = std::make_shared<ParticipantCore>();
  participant->options = options;
  std::memcpy(participant->guid.bytes.data(), "loopback", 8);
  put_big_endian(++last_participant_, participant->guid.bytes.data() + 8);
  participants_.emplace(participant->guid, participant);
  update_presence();
  run_callbacks(lock);
  return participant;
}

void Hub::leave(const std::shared_ptr<ParticipantCore>& participant) {
  Lock lock(mutex_);
  participants_.erase(participant->guid);
  isolated_.erase(participant->guid);
  for (const auto& [guid, other] : participants_) {
    const auto view = other->views.find(participant->guid);
    if (view == other->views.end()) continue;
    // A goodbye reaches those who can hear it; the others wait for the lease.
    if (!view->second.heard) continue;
    forget(*other, participant->guid);
    other->views.erase(participant->guid);
  }
  wait_until_idle(participant.get(), lock);
  participant->options.on_participant = nullptr;
  run_callbacks(lock);
}

void Hub::judge_transfers(std::function<Fate(const Transfer&)> judge) {
  Lock lock(mutex_);
  judge_ = std::move(judge);
}

void Hub::isolate(const Guid& participant) {
  Lock lock(mutex_);
  isolated_.insert(participant);
  update_presence();
  run_callbacks(lock);
}

void Hub::separate(const Guid& one, const Guid& other) {
  Lock lock(mutex_);
  separated_.insert(std::minmax(one, other));
  update_presence();
  run_callbacks(lock);
}

void Hub::heal() {
  Lock lock(mutex_);
  isolated_.clear();
  separated_.clear();
  update_presence();
  run_callbacks(lock);
}

void Hub::pause(const Guid& participant, bool paused) {
  Lock lock(mutex_);
  const auto found = participants_.find(participant);
  if (found == participants_.end() || found->second->paused == paused) return;
  found->second->paused = paused;
  update_presence();
  run_callbacks(lock);
}

void Hub::kill(const Guid& participant) {
  Lock lock(mutex_);
  const auto found = participants_.find(participant);
  if (found == participants_.end()) return;
  found->second->killed = true;
  update_presence();
  run_callbacks(lock);
}

void Hub::deadline_missed(const Guid& endpoint, const KeyHash& key) {
  after(Duration::zero(), [endpoint, key](Hub& hub) {
    const auto tell = [&](const auto& endpoints) {
      const auto found = endpoints.find(endpoint);
      if (found == endpoints.end()) return;
      hub.post(found->second.get(), [core = found->second, key] {
        if (core->listener.on_deadline_missed) core->listener.on_deadline_missed(key);
      });
    };
    tell(hub.writers_);
    tell(hub.readers_);
  });
}

void Hub::post(const EndpointCore* target, Action callback) {
  callbacks_.push_back({target, std::move(callback)});
}

void Hub::run_callbacks(Lock& lock) {
  if (draining_) return;  // the caller is a listener, or another thread is at it
  draining_ = true;
  runner_ = std::this_thread::get_id();
  while (!callbacks_.empty()) {
    Callback callback = std::move(callbacks_.front());
    callbacks_.pop_front();
    running_ = callback.target;
    lock.unlock();
    callback.run();
    callback.run = nullptr;
    lock.lock();
    running_ = nullptr;
    changed_.notify_all();
  }
  draining_ = false;
  runner_ = {};
}

void Hub::wait_until_idle(const void* target, Lock& lock) {
  std::erase_if(callbacks_, [&](const Callback& callback) { return callback.target == target; });
  if (runner_ == std::this_thread::get_id()) return;
  changed_.wait(lock, [&] { return running_ != target; });
}

void Hub::after(Duration delay, std::function<void(Hub&)> action) {
  clock_.call_after(delay, [weak = weak_from_this(), action = std::move(action)] {
    const auto hub = weak.lock();
    if (!hub) return;
    Lock lock(hub->mutex_);
    action(*hub);
    hub->run_callbacks(lock);
  });
}

}  // namespace skein::dds::loopback
