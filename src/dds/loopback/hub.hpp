#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "hub_state.hpp"
#include "loopback_lease_watch.hpp"
#include "matching.hpp"
#include "transfers.hpp"

namespace skein::dds::loopback {

/// The network: its one lock, under which each call and timer asks the parts, and then runs the
/// callbacks outside it.
class Hub : public std::enable_shared_from_this<Hub> {
 public:
  explicit Hub(Clock& clock);

  std::shared_ptr<ParticipantCore> join(const ParticipantOptions& options);
  void leave(const std::shared_ptr<ParticipantCore>& participant);

  template <class Core>
  void add(const std::shared_ptr<Core>& endpoint) {
    Lock lock(mutex_);
    matching_.add(endpoint);
    state_.callbacks.run(lock);
  }
  void remove(EndpointCore& endpoint);

  void write(WriterCore& writer, std::span<const std::byte> cdr, const KeyHash& key,
             InstanceState state);
  bool wait_for_acknowledgments(const WriterCore& writer, std::chrono::milliseconds timeout);
  std::vector<Guid> matched(const EndpointCore& endpoint);

  void judge_transfers(std::function<Fate(const Transfer&)> judge);
  /// Calls that function of the topology.
  template <class Function, class... Arguments>
  void change(Function function, const Arguments&... arguments) {
    Lock lock(mutex_);
    (state_.topology.*function)(arguments...);
    lease_watch_.update_presence();
    state_.callbacks.run(lock);
  }

  Clock& clock() const noexcept { return clock_; }
  /// Tells the endpoint from a timer, not at once: the endpoint's destructor waits for the caller,
  /// perhaps with the hub locked.
  void deadline_missed(const Guid& endpoint, const KeyHash& key);

 private:
  using Lock = CallbackQueue::Lock;

  void wait_for_room(const WriterCore& writer, Lock& lock);
  std::chrono::milliseconds patience(std::chrono::milliseconds wanted) const;
  void after(Duration delay, std::function<void()> action);

  Clock& clock_;
  const bool may_wait_;
  std::mutex mutex_;
  HubState state_;
  Transfers transfers_;
  Matching matching_;
  LoopbackLeaseWatch lease_watch_;
};

}  // namespace skein::dds::loopback
