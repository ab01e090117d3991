#include "cyclone_participant.hpp"

#include "blob.hpp"
#include "configuration.hpp"
#include "core/system/network_interface.hpp"
#include "cyclone_identity.hpp"
#include "cyclone_log.hpp"
#include "cyclone_reader.hpp"
#include "cyclone_writer.hpp"
#include "dds/port/options_check.hpp"
#include "dds/rtps/room_for_participant.hpp"
#include "heartbeats.h"
#include "skein/error.hpp"

namespace skein::dds::cyclonedds {
namespace {

/// Numbers for Cyclone's domains inside this process, above all that have ports.
dds_domainid_t next_internal_domain() {
  static std::atomic<dds_domainid_t> last{100000};
  return ++last;
}

Entity make_domain(const ParticipantOptions& options, dds_domainid_t id) {
  const ErrorCapture errors;
  const dds_entity_t domain = dds_create_domain(id, configuration(options).c_str());
  if (domain > 0) return Entity(domain);
  const std::string down = obstacle_of_this_host(options.network.interfaces);
  throw Unavailable("no participant in domain " + std::to_string(options.domain) + ": " +
                    (down.empty()
                         ? "Cyclone DDS says '" + errors.text() +
                               "'; if all ports are taken, end other participants or raise "
                               "max_participants"
                         : down));
}

}  // namespace

CycloneParticipant::CycloneParticipant(const ParticipantOptions& options) : options_(options) {
  check_options(options);
  refuse_shared_memory(options, "Cyclone DDS");
  require_room_for_participant(options);
  const dds_domainid_t id = next_internal_domain();
  domain_ = make_domain(options, id);
  const QosSet qos;
  if (!options.name.empty()) dds_qset_entity_name(qos.get(), options.name.c_str());
  participant_ = Entity(
      check(dds_create_participant(id, qos.get(), nullptr), "a participant cannot be created"));
  guid_ = participant_.guid().participant();
  internals_ = &find_internals();
  guard_ = std::make_unique<PacketGuard>(*internals_, options_);
  endpoints_.emplace(handle(), guard());
  absences_.emplace(*internals_);
  watch_participants();
  if (options.network.multicast_discovery) membership_.emplace(options);
}

CycloneParticipant::~CycloneParticipant() {
  topics_.expect_unused(options_.name);
  watcher_.reset();
  endpoints_.reset();
  participant_.reset();
}

// A topic's type leads to the domain's internals.
ddsi_domaingv& CycloneParticipant::find_internals() {
  const TopicHandle topic = acquire_topic({"skein/guard", "skein/guard", false});
  auto* internals = static_cast<ddsi_domaingv*>(ddsrt_atomic_ldvoidp(&topic.type->gv));
  release_topic("skein/guard");
  return *internals;
}

void CycloneParticipant::watch_participants() {
  dds_listener_t* listener = dds_create_listener(this);
  dds_lset_data_available(listener, [](dds_entity_t, void* self) {
    static_cast<CycloneParticipant*>(self)->take_presence();
  });
  const dds_entity_t reader = dds_create_reader(
      participant_.handle(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, listener);
  dds_delete_listener(listener);
  watcher_ = Entity(check(reader, "participants cannot be watched"));
  watcher_handle_ = reader;
  take_presence();  // those found before the reader's handle was known
}

void CycloneParticipant::take_presence() {
  std::lock_guard lock(presence_);
  const dds_entity_t watcher = watcher_handle_;
  void* samples[1] = {nullptr};
  dds_sample_info_t info;
  while (watcher > 0 && dds_take(watcher, samples, &info, 1, 1) == 1) {
    const auto* found = static_cast<const dds_builtintopic_participant_t*>(samples[0]);
    const Guid guid = to_guid(found->key).participant();
    const bool present = info.instance_state == DDS_IST_ALIVE;
    dds_return_loan(watcher, samples, 1);
    samples[0] = nullptr;
    if (guid == guid_) continue;
    present ? absences_->found(guid) : absences_->lost(guid);
    present ? guard().found(guid) : guard().removed(guid);
    const bool news = present ? present_.insert(guid).second : present_.erase(guid) > 0;
    if (!news) continue;
    adapt_heartbeats();
    if (options_.on_participant) options_.on_participant(guid, present);
  }
}

void CycloneParticipant::adapt_heartbeats() const {
  const HeartbeatIntervals intervals = heartbeat_intervals(present_.size());
  skein_set_heartbeat_intervals(internals_, std::chrono::nanoseconds(intervals.first).count(),
                                std::chrono::nanoseconds(intervals.longest).count());
}

TopicHandle CycloneParticipant::acquire_topic(const Topic& topic) {
  return topics_.acquire(topic, [&] {
    const QosSet qos;
    ddsi_sertype* type = make_blob_type(topic);
    const dds_entity_t entity =
        dds_create_topic_sertype(handle(), topic.name.c_str(), &type, qos.get(), nullptr, nullptr);
    check(entity, "topic '" + topic.name + "' cannot be created");
    return TopicHandle{entity, type};
  });
}

void CycloneParticipant::release_topic(const std::string& name) {
  topics_.release(name, [](const TopicHandle& topic) { dds_delete(topic.entity); });
}

std::unique_ptr<Writer> CycloneParticipant::create_writer(const Topic& topic, const Qos& qos,
                                                          WriterListener listener) {
  check_qos(topic, qos);
  return std::make_unique<CycloneWriter>(*this, topic, qos, std::move(listener));
}

std::unique_ptr<Reader> CycloneParticipant::create_reader(const Topic& topic, const Qos& qos,
                                                          ReaderListener listener) {
  check_qos(topic, qos);
  return std::make_unique<CycloneReader>(*this, topic, qos, std::move(listener));
}

}  // namespace skein::dds::cyclonedds
