#include "signs_of_life.hpp"

#include <cstring>
#include <mutex>

namespace skein::dds::fastdds {
namespace {

constexpr std::size_t kPrefix = 8;  // of the sender's GUID, in an RTPS header
constexpr std::size_t kPrefixSize = 12;

SignsOfLife::Clock::rep now() { return SignsOfLife::Clock::now().time_since_epoch().count(); }

}  // namespace

void SignsOfLife::follow(const Guid& participant) {
  std::lock_guard lock(mutex_);
  last_[participant] = now();
}

void SignsOfLife::forget(const Guid& participant) {
  constexpr std::size_t kMany = 4096;  // that went and may come back
  std::lock_guard lock(mutex_);
  last_.erase(participant);
  if (returned_.size() >= kMany) returned_.clear();
  returned_[participant] = 0;
}

bool SignsOfLife::heard(const unsigned char* message, std::size_t size) {
  constexpr Clock::duration kJust = std::chrono::milliseconds(100);
  if (size < kPrefix + kPrefixSize) return false;
  Guid sender;
  std::memcpy(sender.bytes.data(), message + kPrefix, kPrefixSize);
  std::shared_lock lock(mutex_);
  const auto found = last_.find(sender);
  if (found != last_.end()) found->second.store(now(), std::memory_order_relaxed);
  const auto lost = returned_.find(sender);
  if (lost == returned_.end()) return false;
  const Clock::rep present = now();
  Clock::rep returned = 0;
  if (lost->second.compare_exchange_strong(returned, present)) returned = present;
  return present - returned < kJust.count();
}

bool SignsOfLife::alive(const Guid& participant, std::chrono::nanoseconds lease) const {
  std::shared_lock lock(mutex_);
  const auto found = last_.find(participant);
  return found == last_.end() ||
         now() - found->second.load(std::memory_order_relaxed) <= Clock::duration(lease).count();
}

}  // namespace skein::dds::fastdds
