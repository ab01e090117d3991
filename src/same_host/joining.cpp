#include "joining.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "core/printable.hpp"
#include "core/system/abstract_socket.hpp"
#include "doorbell.hpp"
#include "handshake.hpp"
#include "skein/error.hpp"

namespace skein::same_host {
namespace {

[[noreturn]] void refuse_to_join(const std::string& why) {
  throw Unavailable("no connection through shared memory: " + why);
}

FileDescriptor connect_to_provider(const Guid& provider, const std::function<bool(uid_t)>& knows) {
  Contact contact = reach(address_of(provider), knows, SOCK_SEQPACKET);
  switch (contact.reached) {
    case Reached::Nobody:
      refuse_to_join("nobody offers one");
    case Reached::Unknown:
      refuse_to_join(std::strerror(errno));
    case Reached::Stranger:
      refuse_to_join("another user offers it, who is not among those that are spoken to");
    case Reached::Yes:
      break;
  }
  return std::move(contact.socket);
}

void await_answer(int socket, std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  pollfd answered{socket, POLLIN, 0};
  const auto deadline = Clock::now() + patience;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    const int count = poll(&answered, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (count > 0) return;
    if (count == 0) refuse_to_join("the provider does not answer");
    if (errno != EINTR) refuse_to_join(std::strerror(errno));
  }
}

}  // namespace

std::shared_ptr<Link> join_provider(const Guid& provider, const Guid& client,
                                    std::function<void()> notify,
                                    const std::function<bool(uid_t)>& knows,
                                    std::chrono::milliseconds patience) {
  const auto socket = std::make_shared<const HandedOver>(connect_to_provider(provider, knows));
  auto hello = make_packet<Hello>();
  hello.client = client;
  Link::DoorbellPair doorbells{new_doorbell(), {}};
  // A provider that has closed already may have said why.
  if (!send_packet(socket->get(), hello, {doorbells.out.get()}) && errno != EPIPE &&
      errno != ECONNRESET) {
    refuse_to_join(std::strerror(errno));
  }
  await_answer(socket->get(), patience);
  JoinAnswer answer{};
  HandedOver handed[2];  // the memory, and the doorbell
  if (!receive_packet(socket->get(), answer, handed)) {
    refuse_to_join("the provider turned it away");
  }
  if (!has_our_version(answer)) refuse_to_join("the two sides are of different versions");
  if (!handed[0]) {
    answer.refusal[sizeof answer.refusal - 1] = '\0';
    refuse_to_join(printable(answer.refusal));
  }
  if (answer.server.participant() != provider.participant()) {
    refuse_to_join("another participant answers under the provider's name");
  }
  auto memory = SharedMemory::map(std::move(handed[0]), Link::kMemory);
  memory.take_descriptor();
  if (!is_doorbell(handed[1])) {
    refuse_to_join("no eventfd came from the provider, or no descriptor is left here");
  }
  doorbells.in = std::move(handed[1]);
  return std::make_shared<Link>(Link::Side::Client, socket, std::move(memory), std::move(doorbells),
                                client, answer.server, std::move(notify));
}

}  // namespace skein::same_host
