#include "offer.hpp"

#include "handshake.hpp"
#include "skein/error.hpp"

namespace skein::same_host {

void Offer::welcome(const std::shared_ptr<Link>& link, const FileDescriptor& memory) {
  std::lock_guard lock(mutex_);
  const int client = link->socket()->get();
  auto answer = make_packet<JoinAnswer>();
  answer.server = server;
  try {
    if (withdrawn_) throw Unavailable("the service has been withdrawn");
    welcome_(link);
    if (send_packet(client, answer, {memory.get(), link->doorbells().out.get()})) return;
  } catch (const Unavailable& why) {
    send_refusal(client, answer, why.what());
  }
  link->close();
}

void Offer::withdraw() {
  std::lock_guard lock(mutex_);
  withdrawn_ = true;
  socket.close();
}

}  // namespace skein::same_host
