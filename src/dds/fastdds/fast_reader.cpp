#include "fast_reader.hpp"

#include "attributes.hpp"
#include "dds/port/sample_format.hpp"
#include "fast_identity.hpp"
#include "skein/error.hpp"

namespace skein::dds::fastdds {

FastReader::FastReader(FastParticipant& participant, const Topic& topic, const Qos& qos,
                       dds::ReaderListener listener)
    : participant_(participant),
      topic_(topic),
      use_(participant, topic),
      on_data_(std::move(listener.on_data)),
      events_(std::make_shared<EndpointEvents>(participant.events(), endpoint_listener(listener))),
      history_(history_attributes(0)),
      queue_(topic.name, qos, std::move(listener.find_key),
             std::move(listener.on_deadline_missed)) {
  auto attributes = reader_attributes(topic, qos);
  std::lock_guard lock(participant.readers().creation());
  reader_ = rtps::RTPSDomain::createRTPSReader(participant_.rtps_participant(), attributes,
                                               payloads_, &history_, this);
  if (reader_ == nullptr) {
    throw Internal("topic '" + topic_.name + "': Fast DDS cannot create a reader");
  }
  guid_ = to_guid(reader_->getGuid());
  if (qos.liveliness_lease) {
    participant_.silence().watch_liveliness(events_, *qos.liveliness_lease);
  }
  if (EndpointWatch::is_needed(qos, events_->tells_incompatible())) {
    peers_.emplace(participant_.endpoints(),
                   Endpoint{Side::Reader, topic.name, topic.type_name, qos},
                   [events = events_](const Incompatibility& why) { events->incompatible(why); });
  }
  make_known(*participant_.rtps_participant(), *reader_, topic, reader_qos(qos));
  participant_.readers().add(*this);
}

/// The listener stays until the RTPS reader is gone: other threads of Fast DDS's look whether there
/// is one, and call it, without a lock. When the reader has been removed none of them is left.
FastReader::~FastReader() {
  {
    std::scoped_lock lock(participant_.readers().creation(),
                          participant_.transport().discovery.removal());
    participant_.readers().remove(*this);
    rtps::RTPSDomain::removeRTPSReader(reader_);
  }
  events_->close();
}

void FastReader::on_matched(const Guid& writer, bool now) {
  if (peers_ && peers_->refuses(writer)) return;
  events_->matched(writer, now);
}

EndpointListener FastReader::endpoint_listener(dds::ReaderListener& listener) {
  auto on_liveliness = std::move(listener.on_liveliness);
  return {std::move(listener.on_matched),
          [this, tell = std::move(on_liveliness)](const Guid& writer, bool alive) {
            if (!alive) queue_.writer_not_alive(writer);
            if (tell) tell(writer, alive);
          },
          std::move(listener.on_incompatible)};
}

/// Called before the writer's first sample.
void FastReader::on_writer(const Guid& writer, const AnnouncedWriter* found) {
  participant_.transport().guard.matched(writer, rtps_message::entity_of(guid_), found != nullptr);
  if (found == nullptr) {
    queue_.writer_unmatched(writer);
    return;
  }
  if (peers_) peers_->consider(writer, to_endpoint(Side::Writer, AnnouncedEndpoint(*found)));
  queue_.writer_matched(
      writer, {static_cast<std::int32_t>(strength_of(*found)), from_duration(lifespan_of(*found))});
}

/// Called with the RTPS reader's mutex held.
void FastReader::on_received(const rtps::CacheChange_t& change) {
  const bool stored = store(change);
  history_.remove_change(const_cast<rtps::CacheChange_t*>(&change));
  if (stored && on_data_) on_data_(*this);
}

bool FastReader::store(const rtps::CacheChange_t& change) {
  if (peers_ && peers_->refuses(to_guid(change.writerGUID))) return false;
  if (change.kind == rtps::NOT_ALIVE_UNREGISTERED) {
    queue_.instance_unregistered(to_guid(change.instanceHandle), to_guid(change.writerGUID));
    return false;
  }
  // Fast DDS also hands on what its writer has withdrawn with a GAP, replaced by a newer one or
  // from before this reader's time, when some of its fragments had come: it looks for it under the
  // wrong number (StatefulReader::processGapMsg). The rest will never come.
  if (!const_cast<rtps::CacheChange_t&>(change).is_fully_assembled()) return false;
  const bool alive = change.kind == rtps::ALIVE;
  std::optional<SourceTime> written(change.sourceTimestamp.to_ns());
  if (*written <= SourceTime::zero()) written.reset();
  return queue_.store({alive ? take_over(change) : Payload{},
                       alive ? InstanceState::Alive : InstanceState::Disposed, key_of(change),
                       to_guid(change.writerGUID), written});
}

void FastReader::drop_incomplete(const Guid& writer, std::int64_t number) {
  std::lock_guard lock(reader_->getMutex());
  rtps::CacheChange_t* change = nullptr;
  const rtps::SequenceNumber_t wanted(static_cast<std::uint64_t>(number));
  if (!history_.get_change(wanted, from_guid<rtps::GUID_t>(writer), &change)) return;
  if (!change->is_fully_assembled()) history_.remove_change(change);
}

Payload FastReader::take_over(const rtps::CacheChange_t& change) {
  Bytes memory = payloads_->take(change);
  const auto cdr = without_padding(memory.data(), memory.size());
  return {cdr, ReceivedPayload(std::move(memory), *payloads_)};
}

std::optional<KeyHash> FastReader::key_of(const rtps::CacheChange_t& change) const {
  if (!topic_.keyed) return KeyHash{};
  if (!change.instanceHandle.isDefined()) return std::nullopt;
  return to_guid(change.instanceHandle);
}

}  // namespace skein::dds::fastdds
