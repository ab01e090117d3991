#pragma once

#include <dds/dds.h>
#include <dds/ddsc/dds_rhc.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "../keyed_queue.hpp"
#include "blob.hpp"

namespace skein::dds::cyclonedds {

/// What Cyclone calls a reader history cache, ours in place of its own: it knows the writer's GUID of
/// each sample and tells a disposal from a writer that merely left, both of which Cyclone's own loses,
/// and it hands samples over with one short lock.
///
/// It never refuses a sample: a refusal stalls Cyclone's receive thread, discovery and leases with it.
class SampleQueue : public dds_rhc {
 public:
  explicit SampleQueue(std::optional<std::uint32_t> depth);

  std::size_t take(const std::function<void(const Sample&)>& consumer, std::size_t limit);
  bool empty();
  std::uint64_t malformed() const noexcept { return malformed_.load(std::memory_order_relaxed); }

 private:
  struct Item {
    BlobReference blob;
    Guid writer;
    InstanceState state;
  };

  static const dds_rhc_ops& operations();
  static bool store(ddsi_rhc* cache, const ddsi_writer_info* writer, ddsi_serdata* data,
                    ddsi_tkmap_instance* instance);
  void push(Item item);
  std::optional<Item> pop();

  dds_reader* reader_ = nullptr;
  std::mutex mutex_;
  KeyedQueue<Item> queue_;
  std::atomic<std::uint64_t> malformed_{0};
};

}  // namespace skein::dds::cyclonedds
