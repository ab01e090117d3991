#include "quiet_links.hpp"

#include <pthread.h>

#include <algorithm>

#include "core/threads/start_thread.hpp"

namespace skein::same_host {

QuietLinks::~QuietLinks() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  for (Watch& watch : watches_) {
    notify(watch);
    watch.thread.join();
  }
}

void QuietLinks::reserve(std::size_t count) {
  std::lock_guard lock(mutex_);
  while (watches_.size() * kMost < count) {
    Watch& added = watches_.emplace_back();
    try {
      added.thread = start_thread(name_, [this, &added] { run(added); });
    } catch (...) {
      watches_.pop_back();
      throw;
    }
  }
}

bool QuietLinks::add(const std::shared_ptr<WatchedLink>& link) {
  std::lock_guard lock(mutex_);
  const auto watch =
      std::ranges::find_if(watches_, [](const auto& each) { return each.links.size() < kMost; });
  if (watch == watches_.end() || !link->link->in().prepare_to_sleep()) return false;
  link->quiet = true;
  watch->links.push_back(link);
  notify(*watch);
  return true;
}

std::size_t QuietLinks::size() const {
  std::lock_guard lock(mutex_);
  std::size_t size = 0;
  for (const Watch& watch : watches_) size += watch.links.size();
  return size;
}

void QuietLinks::drop_ended() {
  std::lock_guard lock(mutex_);
  for (Watch& watch : watches_) {
    if (std::ranges::any_of(watch.links, [](const auto& each) { return each->over.load(); }))
      notify(watch);
  }
}

void QuietLinks::notify(Watch& watch) {
  if (watch.notified.exchange(1) == 0) futex_wake(watch.notified);
}

// ---- a thread

void QuietLinks::run(Watch& watch) {
  pthread_setname_np(pthread_self(), name_.c_str());
  Links links;
  while (true) {
    watch.notified = 0;
    {
      std::lock_guard lock(mutex_);
      if (stopping_) return;
    }
    links = quiet_ones(watch);
    sleep(watch, links);
  }
}

// Lets go of the others: of one whose word has changed something has come. None of them ends here
// under the lock.
QuietLinks::Links QuietLinks::quiet_ones(Watch& watch) {
  Links gone;
  bool come = false;
  Links quiet;
  {
    std::lock_guard lock(mutex_);
    const auto first_gone = std::stable_partition(
        watch.links.begin(), watch.links.end(),
        [](const auto& each) { return !each->over && each->link->in().word() != 0; });
    gone.assign(first_gone, watch.links.end());
    watch.links.erase(first_gone, watch.links.end());
    for (const auto& each : gone) {
      each->quiet = false;
      come = come || !each->over;
    }
    quiet = watch.links;
  }
  if (come) notify_();
  return quiet;
}

void QuietLinks::sleep(Watch& watch, const Links& links) {
  futex_waitv words[kMostWords];
  std::size_t count = 0;
  words[count++] = while_it_is(watch.notified, 0);
  for (const auto& each : links) words[count++] = while_it_is(each->link->in().word(), 1);
  futex_wait(std::span(words, count));
}

}  // namespace skein::same_host
