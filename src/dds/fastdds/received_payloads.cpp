#include "received_payloads.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace skein::dds::fastdds {
namespace {

/// Fast DDS keeps its list of missing fragments where these will lie: at the beginning of each,
/// rounded up, so that the last entry may begin at the payload's end.
constexpr std::size_t kListEntry = sizeof(std::uint32_t);

}  // namespace

// Samples in fragments, whose number the guard limits. Fast DDS says of whom they are only then.
void ReceivedPayloads::reserve(std::uint32_t size, rtps::CacheChange_t& change) {
  std::lock_guard lock(mutex_);
  lend(size, change, {});
}

void ReceivedPayloads::lend(std::uint32_t size, rtps::CacheChange_t& change,
                            const rtps::GUID_t& writer) {
  Bytes memory;
  if (!spare_.empty()) {
    memory = std::move(spare_.back());
    spare_.pop_back();
    spare_size_ -= memory.capacity();
  }
  memory.clear();
  memory.resize(kListEntry + (size + kListEntry - 1) / kListEntry * kListEntry);
  auto& payload = change.serializedPayload;
  payload.data = reinterpret_cast<rtps::octet*>(memory.data());
  payload.max_size = size;
  lent_.push_back({std::move(memory), writer, change.sequenceNumber});
  held_ += lent_.back().cost();
}

bool ReceivedPayloads::copy(const rtps::SerializedPayload_t& data, rtps::CacheChange_t& change) {
  {
    std::lock_guard lock(mutex_);
    if (!may_hold(data.length, change)) return false;
    lend(data.length, change, change.writerGUID);
  }
  change.serializedPayload.length = data.length;
  if (data.length > 0) std::memcpy(change.serializedPayload.data, data.data, data.length);
  return true;
}

// Fast DDS looks through all samples that wait whenever one comes: small ones cost time, too.
std::size_t ReceivedPayloads::Lent::cost() const {
  constexpr std::size_t kChange = 16 << 10;
  return memory.size() + kChange;
}

// What is left out here is lost, as far as the writer knows, and comes again when it is asked for.
bool ReceivedPayloads::may_hold(std::uint32_t size, const rtps::CacheChange_t& change) const {
  constexpr std::size_t kOfAll = 64 << 20;
  constexpr std::size_t kOfParticipant = 8 << 20;
  if (held_ + size <= kOfAll) return true;
  std::size_t of_participant = 0;
  bool first = true;
  for (const Lent& each : lent_) {
    if (each.writer.guidPrefix != change.writerGUID.guidPrefix) continue;
    of_participant += each.cost();
    first &= each.writer != change.writerGUID || change.sequenceNumber < each.number;
  }
  return first || of_participant + size <= kOfParticipant;
}

void ReceivedPayloads::release(rtps::SerializedPayload_t& payload) {
  give_back(withdraw(payload.data));
  payload.data = nullptr;
  payload.length = payload.max_size = payload.pos = 0;
}

Bytes ReceivedPayloads::take(const rtps::CacheChange_t& change) {
  Bytes memory = withdraw(change.serializedPayload.data);
  memory.resize(change.serializedPayload.length);
  return memory;
}

void ReceivedPayloads::give_back(Bytes memory) {
  constexpr std::size_t kMaxSpares = 4;
  constexpr std::size_t kMaxSpareSize = 16 << 20;
  if (memory.capacity() == 0) return;  // disposed, or taken over
  std::lock_guard lock(mutex_);
  if (spare_.size() >= kMaxSpares || spare_size_ + memory.capacity() > kMaxSpareSize) return;
  spare_size_ += memory.capacity();
  spare_.push_back(std::move(memory));
}

Bytes ReceivedPayloads::withdraw(const rtps::octet* data) {
  std::lock_guard lock(mutex_);
  const auto found = std::find_if(lent_.begin(), lent_.end(), [&](const Lent& each) {
    return each.memory.data() == reinterpret_cast<const std::byte*>(data);
  });
  if (found == lent_.end()) return {};
  held_ -= found->cost();
  Bytes memory = std::move(found->memory);
  *found = std::move(lent_.back());
  lent_.pop_back();
  return memory;
}

}  // namespace skein::dds::fastdds
