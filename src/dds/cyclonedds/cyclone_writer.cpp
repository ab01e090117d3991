#include "cyclone_writer.hpp"

#include <algorithm>

#include "blob.hpp"
#include "cyclone_identity.hpp"
#include "dds/port/options_check.hpp"
#include "dds/port/sample_format.hpp"
#include "heartbeats.h"
#include "held_samples.h"

namespace skein::dds::cyclonedds {

CycloneWriter::CycloneWriter(CycloneParticipant& participant, const Topic& topic, const Qos& qos,
                             WriterListener listener)
    : participant_(participant),
      topic_(topic),
      qos_(qos),
      use_(participant, topic),
      matches_(
          [this](dds_instance_handle_t* handles, std::size_t room) {
            return dds_get_matched_subscriptions(writer_handle_, handles, room);
          },
          [this](dds_instance_handle_t peer) {
            auto* data = dds_get_matched_subscription_data(writer_handle_, peer);
            if (data == nullptr) return Guid{};
            const Guid guid = to_guid(data->key);
            dds_builtintopic_free_endpoint(data);
            return peers_ && peers_->refuses(guid) ? Guid{} : guid;
          },
          std::move(listener.on_matched)),
      deadline_(make_deadline_timer(qos, std::move(listener.on_deadline_missed))) {
  if (EndpointWatch::is_needed(qos, listener.on_incompatible != nullptr)) {
    peers_.emplace(participant_.endpoints(),
                   Endpoint{Side::Writer, topic.name, topic.type_name, qos},
                   std::move(listener.on_incompatible));
  }
  writer_ = make();
  writer_handle_ = writer_.handle();
  guid_ = writer_.guid();
  matches_.update();
}

CycloneWriter::~CycloneWriter() { writer_.reset(); }

Entity CycloneWriter::make() {
  const QosSet qos(qos_);
  dds_listener_t* listener = dds_create_listener(this);
  dds_lset_publication_matched(listener,
                               [](dds_entity_t, dds_publication_matched_status_t, void* self) {
                                 static_cast<CycloneWriter*>(self)->matches_.update();
                               });
  const dds_entity_t writer =
      dds_create_writer(participant_.handle(), use_.handle().entity, qos.get(), listener);
  dds_delete_listener(listener);
  return Entity(check(writer, "topic '" + topic_.name + "': a writer cannot be created"));
}

void CycloneWriter::write(std::span<const std::byte> cdr, const KeyHash& key) {
  check_sample(cdr, topic_.name);
  wait_for_room();
  Blob* blob = Blob::make_outgoing(use_.handle().type, cdr, topic_.keyed ? key : KeyHash{});
  check_written(dds_writecdr(writer_.handle(), blob));
  if (deadline_) deadline_->heard(topic_.keyed ? key : KeyHash{});
}

void CycloneWriter::dispose(const KeyHash& key) {
  require_keyed(topic_);
  // The payload is the key, for peers that look there: a short key's hash is its big-endian CDR,
  // and travels beside it too.
  Blob* blob = Blob::make(use_.handle().type, SDK_KEY, kHeaderSize + key.bytes.size());
  const std::byte header[kHeaderSize] = {std::byte{0}, std::byte{0}, std::byte{0}, std::byte{0}};
  std::memcpy(blob->bytes(), header, kHeaderSize);
  std::memcpy(blob->bytes() + kHeaderSize, key.bytes.data(), key.bytes.size());
  blob->set_key(key);
  blob->statusinfo = 1;  // disposed; dds_forwardcdr() keeps it, dds_writecdr() does not
  blob->timestamp.v = dds_time();
  check_written(dds_forwardcdr(writer_.handle(), blob));
  if (deadline_) deadline_->ended(key);
}

/// Cyclone itself bounds only the bytes that wait for acknowledgment. Where the samples have no
/// room, all that was written must be acknowledged. How many wait is only looked at when it may be
/// too many; readers are asked before.
void CycloneWriter::wait_for_room() {
  if (!qos_.reliable || qos_.history_depth || qos_.max_samples == 0) return;
  const ddsi_guid_t guid = to_internal(guid_);
  const std::uint64_t written = written_.fetch_add(1);
  const std::uint64_t quarter = std::max(1u, qos_.max_samples / 4);
  if (written > 0 && written % quarter == 0)
    skein_ask_for_acknowledgment(&participant_.internals(), &guid);
  if (written < qos_.max_samples) return;
  const std::uint64_t waiting = skein_held_samples(&participant_.internals(), &guid);
  if (waiting < qos_.max_samples) {
    written_ = waiting + 1;
    return;
  }
  if (!wait_for_acknowledgments(qos_.max_blocking)) check_written(DDS_RETCODE_TIMEOUT);
  written_ = 1;
}

void CycloneWriter::check_written(dds_return_t code) {
  if (code >= 0) return;  // before a text is made of it
  if (code == DDS_RETCODE_TIMEOUT) {
    throw Overloaded("topic '" + topic_.name + "': no room for a sample within " +
                     std::to_string(qos_.max_blocking.count()) +
                     " ms; a matched reader has stopped acknowledging");
  }
  check(code, "topic '" + topic_.name + "': a sample cannot be written");
}

bool CycloneWriter::wait_for_acknowledgments(std::chrono::milliseconds timeout) {
  const dds_return_t code = dds_wait_for_acks(writer_.handle(), DDS_MSECS(timeout.count()));
  if (code == DDS_RETCODE_TIMEOUT) return false;
  check(code, "topic '" + topic_.name + "': acknowledgments cannot be awaited");
  return true;
}

}  // namespace skein::dds::cyclonedds
