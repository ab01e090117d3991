#pragma once

#include <deque>
#include <optional>
#include <string>

#include "rpc/service/turns.hpp"
#include "rpc/wire/transit_delay.hpp"
#include "rpc/wire/wire.hpp"

namespace skein::rpc {

/// A client that `control` is to look at.
struct Newcomer {
  wire::RequestId id;
  bool opens = false;  ///< Otherwise it called without a session.
  std::string strategy{};
  TransitDelay transit{};
  bool left = false;  ///< Meanwhile.
};

/// The clients that wait for that. Peers (participants) take turns, and each has but so much room,
/// so that none that opens thousands of sessions keeps others from opening one. Not thread-safe.
class Newcomers {
 public:
  static constexpr std::size_t kRoom = 1024;
  static constexpr std::size_t kRoomOfPeer = 64;

  /// False where there is no room. Who waits already is not put in again.
  bool push(Newcomer newcomer);

  /// Who waits no longer; it keeps its place, and is marked.
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
