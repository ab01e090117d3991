#include "fast_writer.hpp"

#include <algorithm>

#include "attributes.hpp"
#include "dds/port/options_check.hpp"
#include "dds/port/sample_format.hpp"
#include "fast_identity.hpp"
#include "skein/error.hpp"

namespace skein::dds::fastdds {
namespace {

/// Sends the key hash beside the sample. Left to itself, Fast DDS sends it with disposals only, as
/// its own readers compute it from the data.
void attach_key(rtps::CacheChange_t& change, const KeyHash& key) {
  constexpr rtps::octet kKeyHashParameter[] = {0x70, 0x00, 0x10, 0x00};  // id and length
  constexpr std::uint32_t kSize = sizeof kKeyHashParameter + sizeof key.bytes;
  change.inline_qos.reserve(kSize);
  std::memcpy(change.inline_qos.data, kKeyHashParameter, sizeof kKeyHashParameter);
  std::memcpy(change.inline_qos.data + sizeof kKeyHashParameter, key.bytes.data(),
              key.bytes.size());
  change.inline_qos.length = kSize;
}

}  // namespace

FastWriter::FastWriter(FastParticipant& participant, const Topic& topic, const Qos& qos,
                       dds::WriterListener listener)
    : participant_(participant),
      topic_(topic),
      use_(participant, topic),
      qos_(qos),
      events_(std::make_shared<EndpointEvents>(
          participant.events(),
          EndpointListener{
              std::move(listener.on_matched), {}, std::move(listener.on_incompatible)})),
      history_(history_attributes(bounded() ? qos.max_samples : 0)),
      deadline_(make_deadline_timer(qos, std::move(listener.on_deadline_missed))) {
  if (qos.lifespan && qos.transient_local) {
    Qos every_lifespan;
    every_lifespan.deadline = qos.lifespan;
    lifespan_ =
        make_deadline_timer(every_lifespan, [this](const KeyHash& key) { drop_expired(key); });
  }
  auto attributes = writer_attributes(topic, qos);
  writer_ = rtps::RTPSDomain::createRTPSWriter(participant_.rtps_participant(), attributes,
                                               &history_, this);
  if (writer_ == nullptr) {
    throw Internal("topic '" + topic_.name + "': Fast DDS cannot create a writer");
  }
  guid_ = to_guid(writer_->getGuid());
  if (EndpointWatch::is_needed(qos, events_->tells_incompatible())) {
    peers_.emplace(participant_.endpoints(),
                   Endpoint{Side::Writer, topic.name, topic.type_name, qos},
                   [events = events_](const Incompatibility& why) { events->incompatible(why); });
  }
  {
    std::lock_guard lock(participant_.writers());
    make_known(*participant_.rtps_participant(), *writer_, topic, writer_qos(qos));
  }
  if (qos.liveliness_lease) participant_.assert_liveliness_for(*qos.liveliness_lease);
}

FastWriter::~FastWriter() {
  deadline_.reset();
  lifespan_.reset();
  // Fast DDS gives back the samples of a writer that goes while its timer still looks at them, and
  // may then count holes among them without end.
  history_.remove_all_changes();
  {
    std::scoped_lock lock(participant_.transport().discovery.removal());
    rtps::RTPSDomain::removeRTPSWriter(writer_);
  }
  events_->close();
}

void FastWriter::write(std::span<const std::byte> cdr, const KeyHash& key) {
  check_sample(cdr, topic_.name);
  Lock lock(writer_->getMutex());
  wait_for_room(lock);
  auto* change = make_change(padded(cdr.size()), rtps::ALIVE, key);
  copy_padded(cdr, reinterpret_cast<std::byte*>(change->serializedPayload.data));
  change->serializedPayload.length = static_cast<std::uint32_t>(padded(cdr.size()));
  if (topic_.keyed) attach_key(*change, key);
  remember(change, key);
  send(change);
  const KeyHash instance = topic_.keyed ? key : KeyHash{};
  if (deadline_) deadline_->heard(instance);
  if (lifespan_) lifespan_->heard(instance);
}

void FastWriter::dispose(const KeyHash& key) {
  require_keyed(topic_);
  Lock lock(writer_->getMutex());
  wait_for_room(lock);
  auto* change = make_change(kHeaderSize, rtps::NOT_ALIVE_DISPOSED, key);
  if (qos_.transient_local) drop_all(key);
  remember(change, key);
  send(change);
  if (deadline_) deadline_->ended(key);
}

rtps::CacheChange_t* FastWriter::make_change(std::size_t size, rtps::ChangeKind_t kind,
                                             const KeyHash& key) {
  auto* change = new_change(
      *writer_, history_, static_cast<std::uint32_t>(size), kind,
      topic_.keyed ? from_guid<rtps::InstanceHandle_t>(key) : rtps::c_InstanceHandle_Unknown);
  if (change != nullptr) {
    change->inline_qos.length = 0;  // changes are used again
    return change;
  }
  throw Internal("topic '" + topic_.name + "': Fast DDS has no memory for a sample of " +
                 std::to_string(size) + " bytes");
}

void FastWriter::wait_for_room(Lock& lock) {
  drop_acknowledged();
  if (!bounded() || has_room()) return;
  const auto has_room_now = [&] {
    drop_acknowledged();
    return has_room();
  };
  if (room_.wait_for(lock, qos_.max_blocking, has_room_now)) return;
  throw Overloaded("topic '" + topic_.name + "': no room for a sample within " +
                   std::to_string(qos_.max_blocking.count()) + " ms; " +
                   std::to_string(history_.getHistorySize()) + ", of " +
                   std::to_string(held_bytes_) +
                   " bytes, wait for a matched reader's acknowledgment");
}

/// As much may wait as on Cyclone, whatever its number: a reader that acknowledges nothing would
/// else have the writer take all memory.
bool FastWriter::has_room() {
  constexpr std::size_t kMostBytes = 4 << 20;
  if (qos_.max_samples > 0 && history_.getHistorySize() >= qos_.max_samples) return false;
  return qos_.transient_local || held_bytes_ < kMostBytes;
}

/// A volatile Cyclone reader begins behind the first heartbeat that it hears. Were that one sent
/// amid the fragments of a sample, this sample would be lost; so a heartbeat goes ahead of each
/// sample until all readers have acknowledged something. ("Liveliness": regardless of what is
/// unacknowledged.)
void FastWriter::announce_position() {
  if (!qos_.reliable || new_reader_at_ < 0) return;
  constexpr bool kLiveliness = true;
  send_heartbeat(*writer_, kLiveliness);
}

/// A heartbeat behind each mebibyte, between samples: their memory is free for the next ones at
/// once, and Fast DDS has no reason to send one amid a sample's fragments.
void FastWriter::ask_for_acknowledgment() {
  constexpr std::size_t kOften = 1 << 20;
  if (!qos_.reliable || unasked_bytes_ < kOften) return;
  unasked_bytes_ = 0;
  send_heartbeat(*writer_, false);
}

/// Before it is sent: it may be acknowledged, and gone, while it is being sent.
void FastWriter::remember(rtps::CacheChange_t* change, const KeyHash& key) {
  if (!qos_.history_depth && !qos_.transient_local) return;
  Changes& changes = instances_[topic_.keyed ? key : KeyHash{}];
  if (qos_.history_depth && changes.size() >= *qos_.history_depth) {
    remove(changes.front());
    changes.erase(changes.begin());
  }
  changes.push_back(change);
}

void FastWriter::send(rtps::CacheChange_t* change) {
  announce_position();
  ++last_sent_;
  unasked_bytes_ += change->serializedPayload.length;
  held_bytes_ += change->serializedPayload.length;
  history_.add_change(change);
  ask_for_acknowledgment();
  // Best effort is over when it has been sent, and nothing reports that.
  if (!qos_.reliable && !qos_.transient_local) drop(change);
}

void FastWriter::drop(rtps::CacheChange_t* change) {
  const KeyHash key = topic_.keyed ? to_guid(change->instanceHandle) : KeyHash{};
  if (const auto found = instances_.find(key); found != instances_.end()) {
    std::erase(found->second, change);
    if (found->second.empty()) instances_.erase(found);
  }
  remove(change);
}

void FastWriter::remove(rtps::CacheChange_t* change) {
  held_bytes_ -= change->serializedPayload.length;
  history_.remove_change(change);
}

void FastWriter::drop_all(const KeyHash& key) {
  const auto found = instances_.find(key);
  if (found == instances_.end()) return;
  for (auto* change : found->second) remove(change);
  instances_.erase(found);
}

/// Readers drop what has expired, but not every vendor's goes by the time at which it was written.
void FastWriter::drop_expired(const KeyHash& key) {
  Lock lock(writer_->getMutex());
  const auto found = instances_.find(key);
  if (found != instances_.end()) {
    const auto oldest = std::chrono::system_clock::now().time_since_epoch() - *qos_.lifespan;
    std::erase_if(found->second, [&](rtps::CacheChange_t* change) {
      const bool expired = std::chrono::nanoseconds(change->sourceTimestamp.to_ns()) <= oldest;
      if (expired) remove(change);
      return expired;
    });
    if (!found->second.empty()) return;
    instances_.erase(found);
  }
  lifespan_->ended(key);
}

void FastWriter::on_matched(const Guid& reader, bool now) {
  if (now) new_reader_at_ = last_sent_.load();
  if (peers_ && peers_->refuses(reader)) return;
  events_->matched(reader, now);
}

/// Called before the match.
void FastWriter::on_reader(const Guid& reader, const AnnouncedReader* found) {
  if (found == nullptr || !peers_) return;
  peers_->consider(reader, to_endpoint(Side::Reader, AnnouncedEndpoint(*found)));
}

/// Called with the writer's mutex held, and perhaps with its locators locked. Then what waits to be
/// sent again must not be dropped (forgetting.hpp), which the writer's mutex keeps as it is.
void FastWriter::on_acknowledged_by_all(rtps::CacheChange_t& change) {
  if (!qos_.reliable) return;
  if (static_cast<std::int64_t>(change.sequenceNumber.to64long()) > new_reader_at_) {
    new_reader_at_ = -1;
  }
  // Late joiners need what is alive; that an instance has ended, they need not know.
  if (qos_.transient_local && change.kind == rtps::ALIVE) return;
  if (change.writer_info.is_linked) {
    acknowledged_.push_back(change.sequenceNumber);
  } else {
    drop(&change);
  }
  room_.notify_all();
}

void FastWriter::drop_acknowledged() {
  for (const rtps::SequenceNumber_t& number : acknowledged_) {
    rtps::CacheChange_t* change = nullptr;
    if (history_.get_change(number, writer_->getGuid(), &change)) drop(change);
  }
  acknowledged_.clear();
}

bool FastWriter::wait_for_acknowledgments(std::chrono::milliseconds timeout) {
  return writer_->wait_for_all_acked(
      {static_cast<std::int32_t>(timeout.count() / 1000),
       static_cast<std::uint32_t>(timeout.count() % 1000 * 1'000'000)});
}

}  // namespace skein::dds::fastdds
