#include "hub.hpp"

#include "core/clock_wait.hpp"

namespace skein::dds::loopback {

WriterCore::WriterCore(const Qos& qos, Hub& hub)
    : history(qos.history_depth),
      deadline(make_deadline_timer(
          qos, [this, &hub](const KeyHash& key) { hub.deadline_missed(guid, key); },
          &hub.clock())) {}

ReaderCore::ReaderCore(const Topic& topic, const Qos& qos, Hub& hub)
    : queue(
          topic.name, qos, {}, [this, &hub](const KeyHash& key) { hub.deadline_missed(guid, key); },
          hub.clock()) {}

Hub::Hub(Clock& clock)
    : clock_(clock),
      may_wait_(dynamic_cast<SystemClock*>(&clock) != nullptr),
      state_{[this](Duration delay, auto action) { after(delay, std::move(action)); }},
      transfers_(state_),
      matching_(state_, transfers_),
      lease_watch_(state_, matching_, transfers_) {}

std::shared_ptr<ParticipantCore> Hub::join(const ParticipantOptions& options) {
  Lock lock(mutex_);
  auto participant = state_.topology.join(options);
  lease_watch_.update_presence();
  state_.callbacks.run(lock);
  return participant;
}

void Hub::leave(const std::shared_ptr<ParticipantCore>& participant) {
  Lock lock(mutex_);
  state_.topology.leave(participant->guid);
  lease_watch_.say_goodbye(participant->guid);
  state_.callbacks.drop(participant.get(), lock);
  participant->options.on_participant = nullptr;
  state_.callbacks.run(lock);
}

void Hub::remove(EndpointCore& endpoint) {
  Lock lock(mutex_);
  matching_.remove(endpoint);
  state_.callbacks.drop(&endpoint, lock);
  state_.callbacks.run(lock);
}

void Hub::write(WriterCore& writer, std::span<const std::byte> cdr, const KeyHash& key,
                InstanceState state) {
  const auto message =
      make_shared_in_call_memory<Message>(Message{{cdr.begin(), cdr.end(), &call_memory()},
                                                  key,
                                                  state,
                                                  writer.guid,
                                                  clock_.now().time_since_epoch(),
                                                  0});
  Lock lock(mutex_);
  wait_for_room(writer, lock);
  transfers_.write(writer, message);
  state_.callbacks.run(lock);
}

void Hub::wait_for_room(const WriterCore& writer, Lock& lock) {
  const auto has_room = [&] { return transfers_.has_room(writer); };
  if (has_room()) return;
  const auto waited = patience(writer.qos.max_blocking);
  if (wait_until(clock_, clock_.after(waited), lock, state_.acknowledged, has_room)) return;
  throw Overloaded("topic '" + writer.topic.name + "': " + std::to_string(writer.qos.max_samples) +
                   " samples wait for a reader's acknowledgment, and none was given within " +
                   std::to_string(waited.count()) + " ms");
}

bool Hub::wait_for_acknowledgments(const WriterCore& writer, std::chrono::milliseconds timeout) {
  Lock lock(mutex_);
  return wait_until(clock_, clock_.after(patience(timeout)), lock, state_.acknowledged,
                    [&] { return transfers_.all_arrived(writer); });
}

// A listener may be called on the clock's thread, which cannot wait for itself.
std::chrono::milliseconds Hub::patience(std::chrono::milliseconds wanted) const {
  return may_wait_ && !state_.callbacks.is_caller() ? wanted : std::chrono::milliseconds(0);
}

std::vector<Guid> Hub::matched(const EndpointCore& endpoint) {
  Lock lock(mutex_);
  return matching_.matched(endpoint.guid);
}

void Hub::judge_transfers(std::function<Fate(const Transfer&)> judge) {
  Lock lock(mutex_);
  transfers_.judge_by(std::move(judge));
}

void Hub::deadline_missed(const Guid& endpoint, const KeyHash& key) {
  after(Duration::zero(), [this, endpoint, key] { matching_.deadline_missed(endpoint, key); });
}

void Hub::after(Duration delay, std::function<void()> action) {
  clock_.call_after(delay, [weak = weak_from_this(), action = std::move(action)] {
    const auto hub = weak.lock();
    if (!hub) return;
    Lock lock(hub->mutex_);
    action();
    hub->state_.callbacks.run(lock);
  });
}

}  // namespace skein::dds::loopback
