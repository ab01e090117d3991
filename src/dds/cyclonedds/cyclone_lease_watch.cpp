#include "cyclone_lease_watch.hpp"

#include <pthread.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/threads/stall_watch.hpp"
#include "core/threads/start_thread.hpp"
#include "cyclone_identity.hpp"
#include "proxy_leases.h"

namespace skein::dds::cyclonedds {
namespace {

using std::chrono::nanoseconds;
using namespace std::chrono_literals;

constexpr nanoseconds kLongestSleep = 250ms;
/// Silence that is forgiven for each moment that this process came late.
constexpr int kForgiveness = 6;
/// Cyclone itself gives up a participant after so many of its leases.
constexpr int kBackstop = 16;

constexpr std::uint32_t kParticipantEntity = 0x1c1;

ddsi_guid_t participant_guid(const Guid& participant) {
  ddsi_guid_t guid = to_internal(participant);
  guid.entityid.u = kParticipantEntity;
  return guid;
}

}  // namespace

CycloneLeaseWatch::CycloneLeaseWatch(ddsi_domaingv& domain)
    : domain_(domain), thread_(start_thread("skein-dds-lease", [this] { run(); })) {
  pthread_setname_np(thread_.native_handle(), "skein-dds-lease");
}

CycloneLeaseWatch::~CycloneLeaseWatch() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void CycloneLeaseWatch::found(const Guid& participant) {
  const ddsi_guid_t guid = participant_guid(participant);
  std::lock_guard lock(mutex_);
  // One that Cyclone watches already it goes on watching.
  const nanoseconds announced(skein_lengthen_lease(&domain_, &guid, kBackstop));
  if (announced != 0ns) leases_[participant] = announced;
}

void CycloneLeaseWatch::lost(const Guid& participant) {
  std::lock_guard lock(mutex_);
  leases_.erase(participant);
}

nanoseconds CycloneLeaseWatch::silence_of(const Guid& participant) {
  const ddsi_guid_t guid = participant_guid(participant);
  // One that was lost may just be found again, and its lease be lengthened.
  std::lock_guard lock(mutex_);
  return nanoseconds(skein_silence(&domain_, &guid));
}

nanoseconds CycloneLeaseWatch::check(nanoseconds forgiven) {
  std::map<Guid, nanoseconds> leases;
  {
    std::lock_guard lock(mutex_);
    if (leases_.empty()) return kLongestSleep;
    leases = leases_;
  }
  nanoseconds next = kLongestSleep;
  for (const auto& [participant, announced] : leases) {
    const nanoseconds left = announced + forgiven - silence_of(participant);
    if (left > 0ns) {
      next = std::min(next, left);
    } else {
      give_up(participant);
    }
  }
  return std::max<nanoseconds>(next, 1ms);
}

void CycloneLeaseWatch::give_up(const Guid& participant) {
  constexpr auto kPatience = 10s;
  const ddsi_guid_t guid = participant_guid(participant);
  GivenUp given_up{{}, Clock::now() + kPatience};
  skein_give_up(
      &domain_, &guid,
      [](void* endpoints, const ddsi_guid_t* endpoint) {
        static_cast<std::vector<ddsi_guid_t>*>(endpoints)->push_back(*endpoint);
      },
      &given_up.endpoints);
  given_up_[participant] = std::move(given_up);
}

void CycloneLeaseWatch::delete_left_over() {
  for (const auto& [participant, given_up] : given_up_) {
    for (const ddsi_guid_t& endpoint : given_up.endpoints)
      skein_delete_left_over(&domain_, &endpoint);
  }
  const auto now = Clock::now();
  std::erase_if(given_up_, [&](const auto& each) { return each.second.until < now; });
}

void CycloneLeaseWatch::run() {
  WatchedThread watched("skein-dds-lease");
  nanoseconds late{};
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    lock.unlock();
    watched.begin();
    const nanoseconds sleep = check(kForgiveness * late);
    delete_left_over();
    watched.end();
    const auto due = Clock::now() + sleep;
    lock.lock();
    changed_.wait_until(lock, due, [this] { return stopping_; });
    // What was late is remembered for some seconds.
    late = std::max<nanoseconds>(Clock::now() - due, late * 15 / 16);
  }
}

}  // namespace skein::dds::cyclonedds
