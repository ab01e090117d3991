#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "fast_dds.hpp"
#include "skein/detail/bytes.hpp"

namespace skein::dds::fastdds {

/// The memory into which a reader's samples are received. What has arrived is taken over as it lies
/// there, without a copy, and the memory is kept for samples to come: Fast DDS's own pools give
/// back large ones, and to receive into fresh pages takes longer than to receive. A writer's
/// samples that wait behind one that is missing hold a bounded memory: then only what comes before
/// them is received. Thread-safe.
class ReceivedPayloads final : public PayloadPool {
 public:
  void reserve(std::uint32_t size, rtps::CacheChange_t& change) override;
  bool copy(const rtps::SerializedPayload_t& data, rtps::CacheChange_t& change) override;
  void release(rtps::SerializedPayload_t& payload) override;

  /// Takes a change's payload over; the change may then only be removed.
  Bytes take(const rtps::CacheChange_t& change);

  /// Keeps the memory for other samples, unless there is enough of it.
  void give_back(Bytes memory);

 private:
  struct Lent {
    Bytes memory;
    rtps::GUID_t writer;  // unknown of a sample in fragments
    rtps::SequenceNumber_t number;

    std::size_t cost() const;
  };

  void lend(std::uint32_t size, rtps::CacheChange_t& change, const rtps::GUID_t& writer);
  bool may_hold(std::uint32_t size, const rtps::CacheChange_t& change) const;
  Bytes withdraw(const rtps::octet* data);

  mutable std::mutex mutex_;
  std::vector<Lent> lent_;  // to changes
  std::size_t held_ = 0;    // their cost
  std::vector<Bytes> spare_;
  std::size_t spare_size_ = 0;
};

/// The memory of one sample that was taken over: given back in the end, unless it is kept.
class ReceivedPayload {
 public:
  /// `home` outlives it.
  ReceivedPayload(Bytes memory, ReceivedPayloads& home) noexcept
      : memory_(std::move(memory)), home_(home) {}
  ReceivedPayload(ReceivedPayload&&) noexcept = default;
  ~ReceivedPayload() { home_.give_back(std::move(memory_)); }

  std::shared_ptr<const void> keep() { return std::make_shared<Bytes>(std::move(memory_)); }

 private:
  Bytes memory_;
  ReceivedPayloads& home_;
};

}  // namespace skein::dds::fastdds
