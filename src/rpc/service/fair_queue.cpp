#include "rpc/service/fair_queue.hpp"

#include <algorithm>

#include "rpc/service/invocation.hpp"

namespace skein::rpc {

FairQueue::~FairQueue() {
  while (pop()) {
  }
}

bool FairQueue::has_room(const Guid& connection) const noexcept {
  const Peer* const peer =
      peers_.find([&](const Peer& each) { return each.participant == connection.participant(); });
  return (peer ? peer->size : 0) < capacity_ - std::min(capacity_, size_);
}

void FairQueue::push(std::shared_ptr<Invocation> invocation) {
  Invocation* const last = invocation.get();
  const Guid participant = last->connection.participant();
  Peer* peer = peers_.find([&](const Peer& each) { return each.participant == participant; });
  if (!peer) peer = &peers_.add({participant, {}});
  Line* const line =
      peer->lines.find([&](const Line& each) { return each.connection == last->connection; });
  if (line) {
    line->last->next = std::move(invocation);
    line->last = last;
  } else {
    peer->lines.add({last->connection, std::move(invocation), last});
  }
  ++peer->size;
  ++size_;
}

std::shared_ptr<Invocation> FairQueue::pop() noexcept {
  if (peers_.empty()) return nullptr;
  Peer& peer = peers_.present();
  Line& line = peer.lines.present();
  auto invocation = std::move(line.first);
  line.first = std::move(invocation->next);
  line.first ? peer.lines.pass() : peer.lines.remove();
  --peer.size;
  --size_;
  peer.lines.empty() ? peers_.remove() : peers_.pass();
  return invocation;
}

}  // namespace skein::rpc
