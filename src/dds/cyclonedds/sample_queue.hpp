#pragma once

#include <dds/dds.h>
#include <dds/ddsc/dds_rhc.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "../deadline_watch.hpp"
#include "../keyed_queue.hpp"
#include "../sample_gate.hpp"
#include "blob.hpp"

namespace skein::dds::cyclonedds {

/// What Cyclone calls a reader history cache, ours in place of its own: it knows the writer's GUID
/// of each sample and tells a disposal from a writer that merely left, both of which Cyclone's own
/// loses, and it hands samples over with one short lock.
///
/// It never refuses a sample: a refusal stalls Cyclone's receive thread, discovery and leases with
/// it.
class SampleQueue : public dds_rhc {
 public:
  SampleQueue(const Qos& qos, const ReaderListener& listener);
  /// Cyclone has let go of it. The lock shows what it stored last to those who cannot see into
  /// Cyclone: ThreadSanitizer, say.
  ~SampleQueue() { const std::lock_guard lock(mutex_); }

  std::size_t take(const std::function<void(const Sample&)>& consumer, std::size_t limit);
  bool empty();
  std::uint64_t malformed() const noexcept { return malformed_.load(std::memory_order_relaxed); }
  std::uint64_t expired() const noexcept { return gate_.expired(); }
  std::uint64_t replaced() const noexcept { return replaced_.load(std::memory_order_relaxed); }

 private:
  struct Item {
    BlobReference blob;
    KeyHash key;
    Guid writer;
    InstanceState state;
    SourceTime expiry = SampleGate::kNever;
  };

  static const dds_rhc_ops& operations();
  void store(const ddsi_writer_info& writer, Blob& blob);
  static void writer_gone(ddsi_rhc* cache, const ddsi_writer_info* writer);
  std::optional<KeyHash> key_of(const Blob& blob) const;
  bool push(Item item, const ddsi_writer_info& writer);
  void let_go(const KeyHash& key, const Guid& writer);
  std::optional<Item> pop();

  const decltype(ReaderListener::find_key) find_key_;
  dds_reader* reader_ = nullptr;
  std::mutex mutex_;
  KeyedQueue<Item> queue_;
  SampleGate gate_;
  std::atomic<std::uint64_t> malformed_{0};
  std::atomic<std::uint64_t> replaced_{0};
  std::unique_ptr<DeadlineTimer> deadline_;  // goes first: it uses the rest
};

}  // namespace skein::dds::cyclonedds
