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
  std::lock_guard lock(mutex_);
  last_.erase(participant);
}

void SignsOfLife::heard(const unsigned char* message, std::size_t size) {
  if (size < kPrefix + kPrefixSize) return;
  Guid sender;
  std::memcpy(sender.bytes.data(), message + kPrefix, kPrefixSize);
  std::shared_lock lock(mutex_);
  const auto found = last_.find(sender);
  if (found != last_.end()) found->second.store(now(), std::memory_order_relaxed);
}

bool SignsOfLife::alive(const Guid& participant, std::chrono::nanoseconds lease) const {
  std::shared_lock lock(mutex_);
  const auto found = last_.find(participant);
  return found == last_.end() ||
         now() - found->second.load(std::memory_order_relaxed) <= Clock::duration(lease).count();
}

}  // namespace skein::dds::fastdds
