#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "futex.hpp"
#include "link.hpp"

namespace skein::same_host {

/// A link that QuietLinks can wait for.
struct WatchedLink {
  explicit WatchedLink(std::shared_ptr<Link> link_) : link(std::move(link_)) {}

  const std::shared_ptr<Link> link;
  std::atomic<bool> quiet{false};  ///< QuietLinks waits for it, and nobody else.
  std::atomic<bool> over{false};   ///< Nobody need wait for it any more.
};

/// Waits for links that bring little, so that who takes messages of many others need not: each more
/// link that a thread sleeps on makes its sleep dearer, and the kernel limits how many that are.
/// One thread for each kMostWords - 1 of them. Thread-safe.
class QuietLinks {
 public:
  /// `name` is the threads'; `notify` is called on them once some have come to be quiet no longer.
  QuietLinks(std::string name, std::function<void()> notify)
      : name_(std::move(name)), notify_(std::move(notify)) {}
  ~QuietLinks();
  QuietLinks(const QuietLinks&) = delete;
  QuietLinks& operator=(const QuietLinks&) = delete;

  /// Makes sure of room for so many: their threads start here, with the properties of this one.
  /// Throws Unavailable where the system gives none.
  void reserve(std::size_t count);
  /// Lets the link be quiet until something has come. By who waited for it so far. False where
  /// something has come already, and where there is no room.
  bool add(const std::shared_ptr<WatchedLink>& link);
  /// How many there are.
  std::size_t size() const;
  /// Lets go of those that are over.
  void drop_ended();

 private:
  using Links = std::vector<std::shared_ptr<WatchedLink>>;
  static constexpr std::size_t kMost = kMostWords - 1;

  struct Watch {
    Word notified{0};
    Links links;
    std::thread thread;
  };

  void run(Watch& watch);
  Links quiet_ones(Watch& watch);
  static void sleep(Watch& watch, const Links& links);
  static void notify(Watch& watch);

  const std::string name_;
  const std::function<void()> notify_;
  mutable std::mutex mutex_;
  bool stopping_ = false;
  std::list<Watch> watches_;
};

}  // namespace skein::same_host
