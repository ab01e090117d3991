#include "reader.hpp"

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>

#include "../sample_format.hpp"
#include "attributes.hpp"
#include "identity.hpp"
#include "skein/core/error.hpp"

namespace skein::dds::fastdds {
namespace {

/// Lends out a queued item's buffer.
class Owner final : public SampleOwner {
 public:
  explicit Owner(Bytes& cdr) : cdr_(cdr) {}
  std::shared_ptr<const void> keep() override { return std::make_shared<Bytes>(std::move(cdr_)); }

 private:
  Bytes& cdr_;
};

}  // namespace

FastReader::FastReader(FastParticipant& participant, const Topic& topic, const Qos& qos,
                       dds::ReaderListener listener)
    : participant_(participant),
      topic_(topic),
      on_data_(std::move(listener.on_data)),
      find_key_(std::move(listener.find_key)),
      tells_incompatible_(listener.on_incompatible != nullptr),
      events_(std::make_shared<EndpointEvents>(participant.events(), endpoint_listener(listener))),
      history_(history_attributes(0)),
      queue_(qos.history_depth, qos.max_waiting),
      gate_(qos),
      exclusive_(qos.exclusive),
      deadline_(deadline_timer(qos, std::move(listener.on_deadline_missed))) {
  participant_.acquire_topic(topic);
  auto attributes = reader_attributes(topic, qos);
  std::lock_guard lock(participant.readers());
  reader_ = rtps::RTPSDomain::createRTPSReader(participant_.rtps_participant(), attributes,
                                               payloads_, &history_, this);
  if (reader_ == nullptr) {
    participant_.release_topic(topic_.name);
    throw Internal("topic '" + topic_.name + "': Fast DDS cannot create a reader");
  }
  guid_ = to_guid(reader_->getGuid());
  if (qos.liveliness_lease) participant_.watch_liveliness(events_, *qos.liveliness_lease);
  if (tells_incompatible_) {
    participant_.endpoints().watch({Side::Reader, topic.name, topic.type_name, qos}, events_);
  }
  participant_.rtps_participant()->registerReader(reader_, topic_attributes(topic),
                                                  reader_qos(qos));
}

/// The listener stays until the RTPS reader is gone: other threads of Fast DDS's look whether there
/// is one, and call it, without a lock. When the reader has been removed none of them is left.
FastReader::~FastReader() {
  {
    std::lock_guard lock(participant_.readers());
    rtps::RTPSDomain::removeRTPSReader(reader_);
  }
  deadline_.reset();
  events_->close();
  participant_.release_topic(topic_.name);
}

void FastReader::onReaderMatched(rtps::RTPSReader*,
                                 const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) {
  const Guid writer = to_guid(status.last_publication_handle);
  events_->matched(writer, status.current_count_change > 0);
}

EndpointListener FastReader::endpoint_listener(dds::ReaderListener& listener) {
  auto on_liveliness = std::move(listener.on_liveliness);
  return {std::move(listener.on_matched),
          [this, tell = std::move(on_liveliness)](const Guid& writer, bool alive) {
            if (!alive) {
              std::lock_guard lock(mutex_);
              gate_.release_all(writer);
            }
            if (tell) tell(writer, alive);
          },
          std::move(listener.on_incompatible)};
}

std::unique_ptr<DeadlineTimer> FastReader::deadline_timer(const Qos& qos,
                                                          DeadlineTimer::Missed missed) {
  return make_deadline_timer(qos, [this, tell = std::move(missed)](const KeyHash& key) {
    {
      std::lock_guard lock(mutex_);
      gate_.release(key);
    }
    if (tell) tell(key);
  });
}

/// Called before the writer's first sample.
void FastReader::on_writer_discovery(rtps::RTPSReader*,
                                     rtps::WriterDiscoveryInfo::DISCOVERY_STATUS reason,
                                     const rtps::GUID_t& writer,
                                     const rtps::WriterProxyData* info) {
  const Guid guid = to_guid(writer);
  std::lock_guard lock(mutex_);
  if (reason == rtps::WriterDiscoveryInfo::REMOVED_WRITER) {
    writers_.erase(guid);
    gate_.release_all(guid);
    return;
  }
  const auto& qos = info->m_qos;
  const auto lifespan = from_duration(qos.m_lifespan.duration);
  if (!lifespan && !exclusive_) return;
  writers_[guid] = {static_cast<std::int32_t>(qos.m_ownershipStrength.value), lifespan};
}

/// Called with the RTPS reader's mutex held.
void FastReader::onNewCacheChangeAdded(rtps::RTPSReader*, const rtps::CacheChange_t* const change) {
  const bool stored = store(*change);
  history_.remove_change(const_cast<rtps::CacheChange_t*>(change));
  if (stored && on_data_) on_data_(*this);
}

bool FastReader::store(const rtps::CacheChange_t& change) {
  if (change.kind == rtps::NOT_ALIVE_UNREGISTERED) {
    std::lock_guard lock(mutex_);
    gate_.release(to_guid(change.instanceHandle), to_guid(change.writerGUID));
    return false;
  }
  // Fast DDS also hands on what its writer has withdrawn with a GAP, replaced by a newer one or
  // from before this reader's time, when some of its fragments had come: it looks for it under the
  // wrong number (StatefulReader::processGapMsg). The rest will never come.
  if (!const_cast<rtps::CacheChange_t&>(change).is_fully_assembled()) return false;
  const bool alive = change.kind == rtps::ALIVE;
  const auto& payload = change.serializedPayload;
  const std::span received(reinterpret_cast<const std::byte*>(payload.data), payload.length);
  const auto found = alive && !is_plain_cdr(received) ? std::nullopt : key_of(change, received);
  if (!found) {
    malformed_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  Item item{alive ? payloads_->take(change) : Bytes{},
            alive ? InstanceState::Alive : InstanceState::Disposed, *found,
            to_guid(change.writerGUID)};
  const KeyHash key = item.key;
  {
    std::lock_guard lock(mutex_);
    if (!admit(item, SourceTime(change.sourceTimestamp.to_ns()))) {
      payloads_->give_back(std::move(item.cdr));
      return false;
    }
    if (queue_.push(key, std::move(item))) ++replaced_;
    if (deadline_) alive ? deadline_->heard(key) : deadline_->ended(key);
  }
  return true;
}

std::optional<KeyHash> FastReader::key_of(const rtps::CacheChange_t& change,
                                          std::span<const std::byte> received) const {
  if (!topic_.keyed) return KeyHash{};
  if (change.instanceHandle.isDefined()) return to_guid(change.instanceHandle);
  if (!find_key_ || change.kind != rtps::ALIVE) return std::nullopt;
  return find_key_(received);
}

bool FastReader::admit(Item& item, SourceTime written) {
  if (writers_.empty()) return true;
  const auto writer = writers_.find(item.writer);
  if (writer == writers_.end()) return true;
  const SourceTime now = wall_clock_time();
  // A peer may leave the time out.
  if (written <= SourceTime::zero()) written = now;
  const auto expiry = gate_.admit(item.key, item.writer, writer->second, written, now);
  if (expiry) item.expiry = *expiry;
  return expiry.has_value();
}

std::optional<FastReader::Item> FastReader::pop() {
  std::lock_guard lock(mutex_);
  auto item = queue_.pop();
  while (item && item->expiry != SampleGate::kNever &&
         !gate_.fresh(item->expiry, wall_clock_time())) {
    item = queue_.pop();
  }
  return item;
}

std::size_t FastReader::take(const std::function<void(const Sample&)>& consumer,
                             std::size_t limit) {
  std::size_t taken = 0;
  for (; taken < limit; ++taken) {
    std::optional<Item> item = pop();
    if (!item) break;
    std::span<const std::byte> cdr;
    if (item->state == InstanceState::Alive)
      cdr = without_padding(item->cdr.data(), item->cdr.size());
    Owner owner(item->cdr);
    consumer({cdr, item->state, item->key, item->writer, &owner});
    payloads_->give_back(std::move(item->cdr));
  }
  return taken;
}

}  // namespace skein::dds::fastdds
