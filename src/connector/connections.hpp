#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/weak_list.hpp"
#include "skein/clock.hpp"
#include "skein/detail/channel.hpp"

namespace skein::connector {

/// What an entity has connected to: all of it ends with the entity, whoever still holds proxies,
/// calls or streams. Thread-safe.
class Connections {
 public:
  /// Held while a connection is being opened, since that uses the entity's parts. Throws
  /// Unavailable once the entity has ended.
  class Opening {
   public:
    explicit Opening(Connections& connections);
    ~Opening();
    Opening(const Opening&) = delete;
    Opening& operator=(const Opening&) = delete;

   private:
    Connections& connections_;
  };

  /// One that stands, or is being opened. Ends it at once where the entity has ended.
  void add(const std::shared_ptr<Channel>& channel);

  bool closed() const noexcept { return closed_; }
  /// Throws Unavailable once the entity has ended.
  void refuse_if_closed() const;

  /// Of those that stand.
  std::vector<ConnectionInfo> infos() const;

  /// Waits until `end`, or until the entity has ended.
  void pause(Clock& clock, Instant end);

  /// Ends all connections, now and from now on. Pending calls end as Disconnected.
  void close();

  /// After close(): waits for those who were opening one.
  void await_openings();

 private:
  static void end(Channel& channel);

  std::atomic<bool> closed_{false};  // written under the lock
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int openings_ = 0;
  WeakList<Channel> channels_;
};

}  // namespace skein::connector
