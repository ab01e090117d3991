#include "receive_queue.hpp"

#include <utility>

#include "core/log.hpp"
#include "sample_format.hpp"

namespace skein::dds {
namespace {

/// Lends out a taken sample's payload.
class Owner final : public SampleOwner {
 public:
  explicit Owner(Payload& payload) : payload_(payload) {}
  std::shared_ptr<const void> keep() override { return payload_.keep(); }

 private:
  Payload& payload_;
};

}  // namespace

ReceiveQueue::ReceiveQueue(std::string topic, const Qos& qos, FindKey find_key, Missed missed)
    : ReceiveQueue(std::move(topic), qos, std::move(find_key), std::move(missed), nullptr,
                   [] { return SourceTime(std::chrono::system_clock::now().time_since_epoch()); }) {
}

ReceiveQueue::ReceiveQueue(std::string topic, const Qos& qos, FindKey find_key, Missed missed,
                           Clock& clock)
    : ReceiveQueue(std::move(topic), qos, std::move(find_key), std::move(missed), &clock,
                   [&clock] { return SourceTime(clock.now().time_since_epoch()); }) {}

ReceiveQueue::ReceiveQueue(std::string topic, const Qos& qos, FindKey find_key, Missed missed,
                           Clock* deadlines, std::function<SourceTime()> source_time)
    : topic_(std::move(topic)),
      representation_(qos.representation),
      exclusive_(qos.exclusive),
      find_key_(std::move(find_key)),
      source_time_(std::move(source_time)),
      waiting_(qos.history_depth, qos.max_waiting),
      deadline_(make_deadline_timer(
          qos,
          [this, tell = std::move(missed)](const KeyHash& key) {
            {
              const std::lock_guard lock(mutex_);
              ownership_.release(key);
            }
            if (tell) tell(key);
          },
          deadlines)) {}

/// The lock shows what was stored last to those who cannot see how a vendor let go of its reader:
/// ThreadSanitizer, say.
ReceiveQueue::~ReceiveQueue() { const std::lock_guard lock(mutex_); }

void ReceiveQueue::writer_matched(const Guid& writer, const WriterOffer& offer) {
  if (!offer.lifespan && !exclusive_) return;
  const std::lock_guard lock(mutex_);
  offers_.insert_or_assign(writer, offer);
}

void ReceiveQueue::writer_unmatched(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  offers_.erase(writer);
  ownership_.release_all(writer);
}

void ReceiveQueue::writer_not_alive(const Guid& writer) {
  const std::lock_guard lock(mutex_);
  ownership_.release_all(writer);
}

void ReceiveQueue::instance_unregistered(const KeyHash& key, const Guid& writer) {
  const std::lock_guard lock(mutex_);
  ownership_.release(key, writer);
}

bool ReceiveQueue::store(Arrival arrival) { return put(arrival, nullptr); }

bool ReceiveQueue::store(Arrival arrival, const WriterOffer& offer) { return put(arrival, &offer); }

bool ReceiveQueue::put(Arrival& arrival, const WriterOffer* offer) {
  const std::optional<KeyHash> key = key_of(arrival);
  const std::lock_guard lock(mutex_);
  if (!key) {
    ++counters_.malformed;
    return false;
  }
  if (offer == nullptr && !offers_.empty()) {
    const auto found = offers_.find(arrival.writer);
    if (found != offers_.end()) offer = &found->second;
  }
  const std::optional<SourceTime> expiry = offer != nullptr ? admit(arrival, *key, *offer) : kNever;
  if (!expiry) return false;
  const bool replaced = waiting_.push(
      *key, {std::move(arrival.payload), *key, arrival.writer, arrival.state, *expiry});
  if (replaced) ++counters_.replaced;
  if (deadline_) {
    arrival.state == InstanceState::Alive ? deadline_->heard(*key) : deadline_->ended(*key);
  }
  return true;
}

/// Nothing where the sample is malformed.
std::optional<KeyHash> ReceiveQueue::key_of(const Arrival& arrival) const {
  const bool plain = has_representation(arrival.payload.cdr(), representation_);
  if (arrival.state == InstanceState::Alive && !plain) return std::nullopt;
  if (arrival.key) return arrival.key;
  if (!find_key_ || !plain) return std::nullopt;
  return find_key_(arrival.payload.cdr());
}

/// When the sample expires, counted from when it was written; nothing where it must not pass.
std::optional<SourceTime> ReceiveQueue::admit(const Arrival& arrival, const KeyHash& key,
                                              const WriterOffer& offer) {
  SourceTime expiry = kNever;
  // That an instance has ended stays true.
  if (offer.lifespan && arrival.state == InstanceState::Alive) {
    expiry = saturating_sum(arrival.written ? *arrival.written : source_time_(), *offer.lifespan);
  }
  if (drop_expired(expiry)) {
    note_expired_on_arrival(arrival, *offer.lifespan);
    return std::nullopt;
  }
  if (!expired_in_a_row_.empty()) expired_in_a_row_.erase(arrival.writer);
  if (exclusive_ && !ownership_.owns(key, arrival.writer, offer.strength)) return std::nullopt;
  return expiry;
}

/// Whether that time has come; counted where it has.
bool ReceiveQueue::drop_expired(SourceTime expiry) {
  if (expiry == kNever || source_time_() < expiry) return false;
  ++counters_.expired;
  return true;
}

/// A slow network delivers such samples, too; where no other comes, the clocks differ.
void ReceiveQueue::note_expired_on_arrival(const Arrival& arrival, SourceTime lifespan) {
  constexpr unsigned kTold = 10;
  constexpr std::size_t kMostWriters = 1024;
  if (told_of_expired_) return;
  if (expired_in_a_row_.size() >= kMostWriters) expired_in_a_row_.clear();
  if (++expired_in_a_row_[arrival.writer] < kTold) return;
  told_of_expired_ = true;
  expired_in_a_row_.clear();
  const auto to_text = [](SourceTime time) {
    return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(time).count()) +
           " ms";
  };
  log(LogLevel::Warning, "dds",
      "topic '" + topic_ + "': what participant " + arrival.writer.participant().hex() +
          " writes is " + to_text(source_time_() - arrival.written.value_or(source_time_())) +
          " old when it comes, by the two hosts' clocks, and its lifespan is " + to_text(lifespan) +
          ": all of it is dropped. If the clocks differ, set them by NTP or PTP; otherwise publish "
          "with a longer lifespan");
}

std::optional<ReceiveQueue::Item> ReceiveQueue::pop() {
  const std::lock_guard lock(mutex_);
  std::optional<Item> item = waiting_.pop();
  while (item && drop_expired(item->expiry)) item = waiting_.pop();
  return item;
}

std::size_t ReceiveQueue::take(const std::function<void(const Sample&)>& consumer,
                               std::size_t limit) {
  std::size_t taken = 0;
  for (; taken < limit; ++taken) {
    std::optional<Item> item = pop();
    if (!item) break;
    std::span<const std::byte> cdr;
    if (item->state == InstanceState::Alive) cdr = item->payload.cdr();
    Owner owner(item->payload);
    consumer({cdr, item->state, item->key, item->writer, &owner});
  }
  return taken;
}

bool ReceiveQueue::empty() const {
  const std::lock_guard lock(mutex_);
  return waiting_.empty();
}

ReceiveCounters ReceiveQueue::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace skein::dds
