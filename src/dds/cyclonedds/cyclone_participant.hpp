#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <set>

#include "cyclone_entity.hpp"
#include "cyclone_lease_watch.hpp"
#include "dds/port/topic_table.hpp"
#include "dds/rtps/multicast_membership.hpp"
#include "discovered_endpoints.hpp"
#include "packet_guard.hpp"

struct ddsi_sertype;

namespace skein::dds::cyclonedds {

/// A topic in use: Cyclone's entity, and the type that its samples refer to.
struct TopicHandle {
  dds_entity_t entity;
  const ddsi_sertype* type;
};

/// One participant in a Cyclone domain of its own, so that several in one process are as
/// independent as in several. Its threads are Cyclone's; each domain has its own.
class CycloneParticipant final : public Participant {
 public:
  explicit CycloneParticipant(const ParticipantOptions& options);
  ~CycloneParticipant() override;

  std::unique_ptr<Writer> create_writer(const Topic& topic, const Qos& qos,
                                        WriterListener listener) override;
  std::unique_ptr<Reader> create_reader(const Topic& topic, const Qos& qos,
                                        ReaderListener listener) override;
  Guid guid() const override { return guid_; }

  RtpsGuard& guard() const noexcept { return guard_->guard(); }
  ddsi_domaingv& internals() const noexcept { return *internals_; }
  dds_entity_t handle() const noexcept { return participant_.handle(); }
  TopicHandle acquire_topic(const Topic& topic);
  void release_topic(const std::string& name);

  Endpoints& endpoints() noexcept { return endpoints_->all(); }

 private:
  ddsi_domaingv& find_internals();
  void watch_participants();
  void take_presence();
  void adapt_heartbeats() const;

  ParticipantOptions options_;
  std::unique_ptr<PacketGuard> guard_;  // outlives the domain, whose threads use it
  Entity domain_;
  Entity participant_;
  Guid guid_;
  ddsi_domaingv* internals_ = nullptr;
  TopicTable<TopicHandle> topics_;
  std::optional<DiscoveredEndpoints> endpoints_;
  std::mutex presence_;  // one call of on_participant at a time
  std::set<Guid> present_;
  std::atomic<dds_entity_t> watcher_handle_{0};
  Entity watcher_;  // reads who is there; goes first
  std::optional<CycloneLeaseWatch> absences_;
  std::optional<MulticastMembership> membership_;
};

}  // namespace skein::dds::cyclonedds
