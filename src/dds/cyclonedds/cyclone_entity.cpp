#include "cyclone_entity.hpp"

#include "cyclone_identity.hpp"
#include "dds/port/type_version.hpp"
#include "skein/error.hpp"

namespace skein::dds::cyclonedds {
namespace {

std::vector<const char*> c_strings(const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  return pointers;
}

}  // namespace

dds_return_t check(dds_return_t code, const std::string& what) {
  if (code >= 0) return code;
  throw Internal(what + ": Cyclone DDS says '" + dds_strretcode(-code) + "'");
}

Guid Entity::guid() const {
  dds_guid_t guid{};
  check(dds_get_guid(handle_, &guid), "a GUID cannot be had");
  return to_guid(guid);
}

QosSet::QosSet() : qos_(dds_create_qos()) {
  // One form alone: with both, Fast DDS matches on one side only, and no data arrives.
  dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos_, 1, &representation);
}

QosSet::QosSet(const Qos& qos) : QosSet() {
  if (qos.representation == DataRepresentation::Xcdr2) {
    dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR2;
    dds_qset_data_representation(qos_, 1, &representation);
  }
  if (const auto data = to_user_data(qos.type); !data.empty()) {
    dds_qset_userdata(qos_, data.data(), data.size());
  }
  const auto depth = static_cast<std::int32_t>(qos.history_depth.value_or(1));
  const auto history = qos.history_depth ? DDS_HISTORY_KEEP_LAST : DDS_HISTORY_KEEP_ALL;
  dds_qset_reliability(qos_, qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(qos.max_blocking.count()));
  dds_qset_history(qos_, history, depth);
  dds_qset_durability(
      qos_, qos.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  // What late joiners get is governed by this one, not by the writer's history.
  dds_qset_durability_service(qos_, 0, history, depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED);
  // Otherwise a writer that goes disposes its instances at Cyclone's readers, and only there.
  dds_qset_writer_data_lifecycle(qos_, false);
  if (qos.liveliness_lease) {
    dds_qset_liveliness(qos_, DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(qos.liveliness_lease->count()));
  }
  if (qos.deadline) dds_qset_deadline(qos_, DDS_MSECS(qos.deadline->count()));
  if (qos.lifespan) dds_qset_lifespan(qos_, DDS_MSECS(qos.lifespan->count()));
  if (qos.exclusive) {
    dds_qset_ownership(qos_, DDS_OWNERSHIP_EXCLUSIVE);
    dds_qset_ownership_strength(qos_, qos.strength);
  }
  if (!qos.partitions.empty()) {
    auto names = c_strings(qos.partitions);
    dds_qset_partition(qos_, static_cast<std::uint32_t>(names.size()), names.data());
  }
}

}  // namespace skein::dds::cyclonedds
