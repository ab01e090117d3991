#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <vector>

#include "dds/port/port.hpp"
#include "skein/guid.hpp"

namespace skein::dds::fastdds {

/// The thread on which a participant tells of matches, liveliness and participants. Fast DDS
/// reports them with its own locks held; a listener that waits for a lock whose holder creates an
/// endpoint would then never end.
class EventThread {
 public:
  /// `tick` is called on this thread too, as often as tick_every() says; never without it.
  explicit EventThread(std::function<void()> tick);
  ~EventThread();
  void post(std::function<void()> event);

  /// A user of ticks asks for no shorter period.
  static constexpr std::chrono::nanoseconds kShortestTick = std::chrono::milliseconds(2);
  /// The shortest period asked for counts.
  void tick_every(std::chrono::nanoseconds period);

 private:
  void run();
  std::chrono::steady_clock::time_point next_tick() const;

  const std::function<void()> tick_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> events_;
  bool stopping_ = false;
  std::optional<std::chrono::nanoseconds> period_;
  std::chrono::steady_clock::time_point last_tick_{};
  std::thread thread_;
};

/// Whom to tell of one endpoint's events.
struct EndpointListener {
  std::function<void(const Guid& peer, bool)> on_matched{};
  std::function<void(const Guid& peer, bool)> on_liveliness{};
  std::function<void(const Incompatibility&)> on_incompatible{};
};

/// Who is matched with one endpoint. Kept alive by the events on their way.
class EndpointEvents : public std::enable_shared_from_this<EndpointEvents> {
 public:
  EndpointEvents(EventThread& thread, EndpointListener listener);

  void matched(const Guid& peer, bool now);
  void alive(const Guid& peer, bool now);
  void incompatible(const Incompatibility& why);
  bool tells_incompatible() const { return listener_.on_incompatible != nullptr; }
  std::vector<Guid> peers() const;

  /// Waits for a running listener; none runs afterwards.
  void close();

 private:
  template <class Function, class... Arguments>
  void tell(const Function& function, const Arguments&... arguments);

  EventThread& thread_;
  const EndpointListener listener_;
  mutable std::mutex mutex_;
  std::set<Guid> peers_;
  std::set<Guid> silent_;
  std::mutex telling_;
  bool closed_ = false;  // under telling_
};

}  // namespace skein::dds::fastdds
