#pragma once

#include <cstddef>
#include <memory>

#include "rpc/service/turns.hpp"
#include "skein/guid.hpp"

namespace skein::rpc {

struct Invocation;

/// Invocations that wait for a thread: first in, first out within a connection. Peers take turns,
/// and so do the connections of each, so that one with thousands waiting holds up another by one
/// call. Bounded: a peer may have no more waiting than there is room left, however many connections
/// it has, so that even a full house has room for a newcomer (dynamic thresholds, Choudhury and
/// Hahne 1998). A lone peer gets half of the capacity. Not thread-safe; each operation takes time
/// in the number of peers that wait and of connections that each has.
class FairQueue {
 public:
  explicit FairQueue(std::size_t capacity) : capacity_(capacity) {}
  FairQueue(const FairQueue&) = delete;
  FairQueue& operator=(const FairQueue&) = delete;
  ~FairQueue();

  /// Whether one more of that connection may wait. Connections with the same participant() are of
  /// one peer.
  bool has_room(const Guid& connection) const noexcept;

  /// Puts it last of its connection, without regard to has_room().
  void push(std::shared_ptr<Invocation> invocation);

  /// The next in turn; nullptr where none waits.
  std::shared_ptr<Invocation> pop() noexcept;

  std::size_t size() const noexcept { return size_; }

 private:
  struct Line {
    Guid connection;
    std::shared_ptr<Invocation> first;
    Invocation* last = nullptr;
  };
  struct Peer {
    Guid participant;
    Turns<Line> lines;  // none is empty
    std::size_t size = 0;
  };

  const std::size_t capacity_;
  std::size_t size_ = 0;
  Turns<Peer> peers_;  // each has lines
};

}  // namespace skein::rpc
