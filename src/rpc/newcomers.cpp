#include "newcomers.hpp"

#include <algorithm>
#include <utility>

namespace skein::rpc {

bool Newcomers::push(Newcomer newcomer) {
  const Guid participant = newcomer.id.client.participant();
  Peer* peer = peers_.find([&](const Peer& each) { return each.participant == participant; });
  if (peer) {
    const auto same = std::find_if(peer->line.begin(), peer->line.end(), [&](const Newcomer& each) {
      return each.id.client == newcomer.id.client;
    });
    if (same != peer->line.end()) {
      if (newcomer.opens) *same = std::move(newcomer);
      return true;
    }
  }
  if ((peer ? peer->line.size() : 0) >= std::min(kRoomOfPeer, kRoom - size_)) return false;
  if (!peer) peer = &peers_.add({participant});
  peer->line.push_back(std::move(newcomer));
  ++size_;
  return true;
}

std::optional<Newcomer> Newcomers::pop() {
  if (peers_.empty()) return std::nullopt;
  Peer& peer = peers_.present();
  std::optional<Newcomer> next(std::move(peer.line.front()));
  peer.line.pop_front();
  --size_;
  peer.line.empty() ? peers_.remove() : peers_.pass();
  return next;
}

}  // namespace skein::rpc
