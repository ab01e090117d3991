#pragma once

#include <deque>
#include <optional>
#include <string>

#include "rpc/service/turns.hpp"
#include "rpc/wire/transit_delay.hpp"
#include "rpc/wire/wire.hpp"

namespace skein::rpc {

/// A client that waits for admission, which runs on `control`.
struct Newcomer {
  wire::RequestId id;
  bool opens = false;  ///< Otherwise it called without a session.
  std::string strategy{};
  TransitDelay transit{};
  bool left = false;  ///< While it waited.
};

/// The clients that wait for admission. Peers (participants) take turns, and the places of each are
/// limited, so a peer that opens thousands of sessions cannot keep others out. Not thread-safe.
class Newcomers {
 public:
  static constexpr std::size_t kRoom = 1024;
  static constexpr std::size_t kRoomOfPeer = 64;

  /// Returns false if there is no room. A client that waits already keeps its place; the newer
  /// request replaces the older if it opens a session, or if the client had left.
  bool push(Newcomer newcomer);

  /// Marks a client that left; it keeps its place in the line.
  void note_left(const Guid& client);

  std::optional<Newcomer> pop();

  bool empty() const noexcept { return peers_.empty(); }

 private:
  struct Peer {
    Guid participant;
    std::deque<Newcomer> line{};  // never empty
  };

  Peer* peer_of(const Guid& client);
  static Newcomer* find(Peer& peer, const Guid& client);

  Turns<Peer> peers_;
  std::size_t size_ = 0;
};

}  // namespace skein::rpc
