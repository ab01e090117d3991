#include "mismatches.hpp"

#include <algorithm>
#include <vector>

#include "../compatibility.hpp"
#include "../type_version.hpp"
#include "identity.hpp"
#include "participant.hpp"

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

/// All samples that a reader of a built-in topic holds, for as long as it lives.
class Endpoints {
 public:
  explicit Endpoints(dds_entity_t reader) : reader_(reader) {
    for (std::size_t room = 64;; room *= 4) {
      samples_.assign(room, nullptr);
      infos_.resize(room);
      count_ = dds_read_mask(reader_, samples_.data(), infos_.data(), room,
                             static_cast<std::uint32_t>(room),
                             DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
      if (count_ < static_cast<dds_return_t>(room)) return;
      dds_return_loan(reader_, samples_.data(), count_);
    }
  }
  ~Endpoints() {
    if (count_ > 0) dds_return_loan(reader_, samples_.data(), count_);
  }
  Endpoints(const Endpoints&) = delete;
  Endpoints& operator=(const Endpoints&) = delete;

  template <class Visit>
  void for_each(const Visit& visit) const {
    for (dds_return_t i = 0; i < count_; ++i) {
      if (infos_[i].valid_data)
        visit(*static_cast<const dds_builtintopic_endpoint_t*>(samples_[i]));
    }
  }

 private:
  const dds_entity_t reader_;
  std::vector<void*> samples_;
  std::vector<dds_sample_info_t> infos_;
  dds_return_t count_ = 0;
};

}  // namespace

Mismatches::Mismatches(CycloneParticipant& participant, Topic topic, Qos qos, Side side, Told told)
    : topic_(std::move(topic)),
      qos_(std::move(qos)),
      side_(side),
      told_(std::move(told)),
      peers_(!told_                 ? 0
             : side == Side::Reader ? participant.publications()
                                    : participant.subscriptions()) {}

void Mismatches::mismatched(std::uint32_t policy) {
  if (policy != DDS_PARTITION_QOS_POLICY_ID) update();
}

void Mismatches::update() {
  if (!told_) return;
  std::lock_guard lock(mutex_);
  const Endpoints endpoints(peers_);
  endpoints.for_each([&](const dds_builtintopic_endpoint_t& peer) { consider(peer); });
}

void Mismatches::matched(const dds_builtintopic_endpoint_t& peer) {
  if (!told_ || qos_.type.signature == 0) return;
  std::lock_guard lock(mutex_);
  consider(peer);
}

void Mismatches::consider(const dds_builtintopic_endpoint_t& peer) {
  if (topic_.name != peer.topic_name || topic_.type_name != peer.type_name) return;
  const Guid guid = to_guid(peer.key);
  const Qos qos = to_qos(peer.qos);
  const Qos& offered = side_ == Side::Writer ? qos_ : qos;
  const Qos& requested = side_ == Side::Writer ? qos : qos_;
  if (!share_partition(offered, requested)) return;
  const auto why = find_incompatibility(topic_.name, guid, offered, requested);
  if (why && known_.insert(guid).second) told_(*why);
}

}  // namespace skein::dds::cyclonedds
