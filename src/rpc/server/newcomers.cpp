#include "newcomers.hpp"

#include <algorithm>
#include <utility>

namespace skein::rpc {

Newcomers::Peer* Newcomers::peer_of(const Guid& client) {
  return peers_.find([participant = client.participant()](const Peer& each) {
    return each.participant == participant;
  });
}

Newcomer* Newcomers::find(Peer& peer, const Guid& client) {
  const auto found = std::find_if(peer.line.begin(), peer.line.end(),
                                  [&](const Newcomer& each) { return each.id.client == client; });
  return found == peer.line.end() ? nullptr : &*found;
}

bool Newcomers::push(Newcomer newcomer) {
  Peer* peer = peer_of(newcomer.id.client);
  if (Newcomer* const same = peer ? find(*peer, newcomer.id.client) : nullptr) {
    if (newcomer.opens || same->left) *same = std::move(newcomer);
    return true;
  }
  if ((peer ? peer->line.size() : 0) >= std::min(kRoomOfPeer, kRoom - size_)) return false;
  if (!peer) peer = &peers_.add({newcomer.id.client.participant()});
  peer->line.push_back(std::move(newcomer));
  ++size_;
  return true;
}

void Newcomers::note_left(const Guid& client) {
  Peer* const peer = peer_of(client);
  if (Newcomer* const newcomer = peer ? find(*peer, client) : nullptr) newcomer->left = true;
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
