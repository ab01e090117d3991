#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "callback_queue.hpp"
#include "topology.hpp"
#include "unacknowledged.hpp"

namespace skein::dds::loopback {

/// A matched writer and reader. Either side may know of the match without the other.
struct Match {
  std::shared_ptr<WriterCore> writer;
  std::shared_ptr<ReaderCore> reader;
  bool writer_side = false;
  bool reader_side = false;
  bool alive = true;
  bool repeating = false;  // a timer will repeat lost samples
  std::uint64_t delivered = 0;
  Unacknowledged pending{};  // reliable only
};

using MatchId = std::pair<Guid, Guid>;  // writer, reader

/// The state that the hub's parts share, under its lock.
struct HubState {
  /// Runs the action after the delay, under the lock, and then the callbacks.
  const std::function<void(Duration delay, std::function<void()> action)> later;
  std::condition_variable acknowledged{};  // notified when samples are, or given up
  Topology topology{};
  std::map<MatchId, Match> matches{};
  CallbackQueue callbacks{};
};

}  // namespace skein::dds::loopback
