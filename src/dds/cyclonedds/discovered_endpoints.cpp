#include "discovered_endpoints.hpp"

#include <algorithm>
#include <vector>

#include "cyclone_identity.hpp"
#include "dds/port/type_version.hpp"

namespace skein::dds::cyclonedds {
namespace {

std::optional<std::chrono::milliseconds> period(dds_duration_t duration) {
  if (duration == DDS_INFINITY) return std::nullopt;
  return std::chrono::milliseconds(duration / 1'000'000);
}

std::vector<std::string> partitions_of(const dds_qos_t* from) {
  std::uint32_t count = 0;
  char** names = nullptr;
  if (!dds_qget_partition(from, &count, &names)) return {};
  std::vector<std::string> partitions(names, names + count);
  for (std::uint32_t i = 0; i < count; ++i) dds_free(names[i]);
  dds_free(names);
  return partitions;
}

DataRepresentation representation_of(const dds_qos_t* from) {
  std::uint32_t count = 0;
  dds_data_representation_id_t* values = nullptr;
  if (!dds_qget_data_representation(from, &count, &values)) return DataRepresentation::Xcdr1;
  const bool xcdr1 =
      count == 0 || std::count(values, values + count, DDS_DATA_REPRESENTATION_XCDR1);
  const bool xcdr2 = std::count(values, values + count, DDS_DATA_REPRESENTATION_XCDR2) > 0;
  dds_free(values);
  return xcdr1 && xcdr2 ? DataRepresentation::Any
         : xcdr2        ? DataRepresentation::Xcdr2
                        : DataRepresentation::Xcdr1;
}

TypeVersion type_version_of(const dds_qos_t* from) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(from, &data, &size) || data == nullptr) return {};
  TypeVersion version = from_user_data({static_cast<const std::uint8_t*>(data), size});
  dds_free(data);
  return version;
}

/// The policies that decide about a match.
Qos to_qos(const dds_qos_t* from) {
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_liveliness_kind_t liveliness = DDS_LIVELINESS_AUTOMATIC;
  dds_ownership_kind_t ownership = DDS_OWNERSHIP_SHARED;
  dds_duration_t blocking = 0;
  dds_duration_t deadline = DDS_INFINITY;
  dds_duration_t lease = DDS_INFINITY;
  dds_qget_reliability(from, &reliability, &blocking);
  dds_qget_durability(from, &durability);
  dds_qget_deadline(from, &deadline);
  dds_qget_liveliness(from, &liveliness, &lease);
  dds_qget_ownership(from, &ownership);
  Qos qos;
  qos.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  qos.transient_local = durability != DDS_DURABILITY_VOLATILE;
  qos.deadline = period(deadline);
  qos.liveliness_lease = period(lease);
  qos.exclusive = ownership == DDS_OWNERSHIP_EXCLUSIVE;
  qos.representation = representation_of(from);
  qos.partitions = partitions_of(from);
  qos.type = type_version_of(from);
  return qos;
}

/// Empty where it told none, or has gone.
std::string name_of(dds_entity_t participants, dds_instance_handle_t participant) {
  void* samples[1] = {nullptr};
  dds_sample_info_t info;
  if (dds_read_instance(participants, samples, &info, 1, 1, participant) != 1) return {};
  char* name = nullptr;
  if (info.valid_data) {
    const auto& found = *static_cast<const dds_builtintopic_participant_t*>(samples[0]);
    dds_qget_entity_name(found.qos, &name);
  }
  std::string text = name ? name : "";
  dds_free(name);
  dds_return_loan(participants, samples, 1);
  return text;
}

}  // namespace

DiscoveredEndpoints::DiscoveredEndpoints(dds_entity_t participant, RtpsGuard& guard)
    : writers_{Side::Writer, all_, guard}, readers_{Side::Reader, all_, guard} {
  participants_ = Entity(
      check(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
            "participants cannot be watched"));
  writers_.participants = readers_.participants = participants_.handle();
  open(writers_, participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION);
  open(readers_, participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION);
}

void DiscoveredEndpoints::open(Source& source, dds_entity_t participant, dds_entity_t topic) {
  dds_listener_t* listener = dds_create_listener(&source);
  dds_lset_data_available(listener,
                          [](dds_entity_t, void* self) { take(*static_cast<Source*>(self)); });
  const dds_entity_t reader = dds_create_reader(participant, topic, nullptr, listener);
  dds_delete_listener(listener);
  source.reader = Entity(check(reader, "endpoints cannot be watched"));
  source.handle = reader;
  take(source);  // those found before the reader's handle was known
}

void DiscoveredEndpoints::take(Source& source) {
  std::lock_guard lock(source.taking);
  const dds_entity_t reader = source.handle;
  void* samples[1] = {nullptr};
  dds_sample_info_t info;
  while (reader > 0 && dds_take(reader, samples, &info, 1, 1) == 1) {
    const auto& found = *static_cast<const dds_builtintopic_endpoint_t*>(samples[0]);
    const Guid guid = to_guid(found.key);
    if (info.instance_state != DDS_IST_ALIVE) {
      source.guard.endpoint_removed(guid);
      source.all.lost(guid);
    } else if (info.valid_data) {
      source.guard.endpoint_found(guid);
      source.all.found(guid, {source.side, found.topic_name, found.type_name, to_qos(found.qos),
                              name_of(source.participants, found.participant_instance_handle)});
    }
    dds_return_loan(reader, samples, 1);
    samples[0] = nullptr;
  }
}

}  // namespace skein::dds::cyclonedds
