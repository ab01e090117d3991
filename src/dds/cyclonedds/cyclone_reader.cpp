#include "cyclone_reader.hpp"

#include "cyclone_identity.hpp"

namespace skein::dds::cyclonedds {

CycloneReader::CycloneReader(CycloneParticipant& participant, const Topic& topic, const Qos& qos,
                             ReaderListener listener)
    : participant_(participant),
      topic_(topic),
      use_(participant, topic),
      listener_(std::move(listener)),
      queue_(topic.name, qos, listener_.find_key, listener_.on_deadline_missed),
      cache_(queue_, peers_),
      matches_(
          [this](dds_instance_handle_t* handles, std::size_t room) {
            return dds_get_matched_publications(reader_handle_, handles, room);
          },
          [this](dds_instance_handle_t peer) {
            auto* data = dds_get_matched_publication_data(reader_handle_, peer);
            if (data == nullptr) return Guid{};
            const Guid guid = to_guid(data->key);
            dds_builtintopic_free_endpoint(data);
            return peers_ && peers_->refuses(guid) ? Guid{} : guid;
          },
          [this](const Guid& writer, bool now) { matched(writer, now); }, listener_.on_liveliness) {
  if (EndpointWatch::is_needed(qos, listener_.on_incompatible != nullptr)) {
    peers_.emplace(participant_.endpoints(),
                   Endpoint{Side::Reader, topic.name, topic.type_name, qos},
                   listener_.on_incompatible);
  }
  reader_ = make(topic, qos);
  reader_handle_ = reader_.handle();
  guid_ = reader_.guid();
  made_ = true;
  // What came while the reader was being made was not told: its listener's user had no reader yet.
  matches_.update();
  if (!queue_.empty()) data_available();
}

CycloneReader::~CycloneReader() {
  const auto number = static_cast<std::uint32_t>(reader_.handle());
  reader_.reset();
  participant_.guard().reader_gone(number);
}

void CycloneReader::matched(const Guid& writer, bool now) {
  participant_.guard().matched(writer, static_cast<std::uint32_t>(reader_handle_), now);
  if (listener_.on_matched) listener_.on_matched(writer, now);
}

Entity CycloneReader::make(const Topic& topic, const Qos& wanted) {
  const QosSet qos(wanted);
  dds_listener_t* listener = dds_create_listener(this);
  dds_lset_data_available(listener, [](dds_entity_t, void* self) {
    static_cast<CycloneReader*>(self)->data_available();
  });
  dds_lset_subscription_matched(listener,
                                [](dds_entity_t, dds_subscription_matched_status_t, void* self) {
                                  static_cast<CycloneReader*>(self)->matches_.update();
                                });
  dds_lset_liveliness_changed(listener,
                              [](dds_entity_t, dds_liveliness_changed_status_t status, void* self) {
                                static_cast<CycloneReader*>(self)->liveliness_changed(status);
                              });
  const dds_entity_t reader = dds_create_reader_rhc(participant_.handle(), use_.handle().entity,
                                                    qos.get(), listener, &cache_);
  dds_delete_listener(listener);
  return Entity(check(reader, "topic '" + topic.name + "': a reader cannot be created"));
}

void CycloneReader::data_available() {
  if (!listener_.on_data || !made_) return;
  std::lock_guard lock(data_);
  listener_.on_data(*this);
}

void CycloneReader::liveliness_changed(const dds_liveliness_changed_status_t& status) {
  if (status.not_alive_count_change > 0) {
    matches_.liveliness_changed(status.last_publication_handle, false);
  } else if (status.alive_count_change > 0) {
    matches_.liveliness_changed(status.last_publication_handle, true);
  }
}

}  // namespace skein::dds::cyclonedds
