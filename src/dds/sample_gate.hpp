#pragma once

#include <atomic>
#include <map>
#include <unordered_map>

#include "skein/dds/port.hpp"

namespace skein::dds {

/// Time since any epoch that samples' source timestamps count from too.
using SourceTime = std::chrono::nanoseconds;

/// The time of hosts' clocks.
SourceTime wall_clock_time();

/// What a reader does to samples for the sake of ownership and lifespan (DDS 1.4, 2.2.3.9
/// and 2.2.3.16), alike on every back end. Whoever queues the samples guards it; only expired() is
/// thread-safe.
class SampleGate {
 public:
  static constexpr SourceTime kNever = SourceTime::max();

  explicit SampleGate(const Qos& qos) : exclusive_(qos.exclusive) {}

  /// What the writer's QoS say, before its first sample.
  struct Writer {
    std::int32_t strength = 0;
    std::optional<std::chrono::nanoseconds> lifespan{};
  };

  /// When the sample expires, counted from when it was written; nothing where it must not pass now.
  std::optional<SourceTime> admit(const KeyHash& key, const Guid& from, const Writer& writer,
                                  SourceTime written, SourceTime now);

  /// Whether a sample that was admitted may still be handed over; counted where it may not.
  bool fresh(SourceTime expiry, SourceTime now);

  /// The writer has gone, or is silent: others may own its instances.
  void release_all(const Guid& writer);
  /// The writer lets go of one instance.
  void release(const KeyHash& key, const Guid& writer);
  /// The instance's owner, whoever it is, missed the deadline.
  void release(const KeyHash& key);

  std::uint64_t expired() const noexcept { return expired_.load(std::memory_order_relaxed); }

 private:
  struct Owner {
    Guid writer;
    std::int32_t strength;
  };

  bool owns(const KeyHash& key, const Guid& writer, std::int32_t strength);

  const bool exclusive_;
  std::unordered_map<KeyHash, Owner> owners_;
  std::atomic<std::uint64_t> expired_{0};
};

}  // namespace skein::dds
