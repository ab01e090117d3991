#pragma once

#include <dds/dds.h>
#include <dds/ddsc/dds_rhc.h>

#include "blob.hpp"
#include "dds/port/endpoints.hpp"
#include "dds/port/receive_queue.hpp"

namespace skein::dds::cyclonedds {

/// What Cyclone calls a reader history cache, ours in place of its own: it knows the writer's GUID
/// of each sample and tells a disposal from a writer that merely left, both of which Cyclone's own
/// loses. It keeps nothing, but hands all on to the reader's queue, in that one's terms.
///
/// It never refuses a sample: a refusal stalls Cyclone's receive thread, discovery and leases with
/// it.
class HistoryCache : public dds_rhc {
 public:
  /// Both outlive it. Nothing is handed on of whom `peers` refuses.
  HistoryCache(ReceiveQueue& queue, const std::optional<EndpointWatch>& peers);

 private:
  static const dds_rhc_ops& operations();
  void store(const ddsi_writer_info& writer, Blob& blob);

  ReceiveQueue& queue_;
  const std::optional<EndpointWatch>& peers_;
  dds_reader* reader_ = nullptr;
};

}  // namespace skein::dds::cyclonedds
