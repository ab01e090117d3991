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

bool ReceivedPayloads::get_payload(std::uint32_t size, rtps::CacheChange_t& change) {
  std::lock_guard lock(mutex_);
  Bytes memory;
  if (!spare_.empty()) {
    memory = std::move(spare_.back());
    spare_.pop_back();
  }
  memory.clear();
  memory.resize(kListEntry + (size + kListEntry - 1) / kListEntry * kListEntry);
  auto& payload = change.serializedPayload;
  payload.data = reinterpret_cast<rtps::octet*>(memory.data());
  payload.max_size = size;
  change.payload_owner(this);
  lent_.push_back(std::move(memory));
  return true;
}

bool ReceivedPayloads::get_payload(rtps::SerializedPayload_t& data, rtps::IPayloadPool*&,
                                   rtps::CacheChange_t& change) {
  get_payload(data.length, change);
  change.serializedPayload.length = data.length;
  if (data.length > 0) std::memcpy(change.serializedPayload.data, data.data, data.length);
  return true;
}

bool ReceivedPayloads::release_payload(rtps::CacheChange_t& change) {
  give_back(withdraw(change.serializedPayload.data));
  auto& payload = change.serializedPayload;
  payload.data = nullptr;
  payload.length = payload.max_size = payload.pos = 0;
  change.payload_owner(nullptr);
  return true;
}

Bytes ReceivedPayloads::take(const rtps::CacheChange_t& change) {
  Bytes memory = withdraw(change.serializedPayload.data);
  memory.resize(change.serializedPayload.length);
  return memory;
}

void ReceivedPayloads::give_back(Bytes memory) {
  constexpr std::size_t kMaxSpares = 4;
  if (memory.capacity() == 0) return;  // disposed, or taken over
  std::lock_guard lock(mutex_);
  if (spare_.size() < kMaxSpares) spare_.push_back(std::move(memory));
}

Bytes ReceivedPayloads::withdraw(const rtps::octet* data) {
  std::lock_guard lock(mutex_);
  const auto found = std::find_if(lent_.begin(), lent_.end(), [&](const Bytes& each) {
    return each.data() == reinterpret_cast<const std::byte*>(data);
  });
  if (found == lent_.end()) return {};
  Bytes memory = std::move(*found);
  *found = std::move(lent_.back());
  lent_.pop_back();
  return memory;
}

}  // namespace skein::dds::fastdds
