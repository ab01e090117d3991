#include "packet_guard.hpp"

#include <arpa/inet.h>
#include <dds/ddsi/ddsi_tran.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>

#include "core/system/file_descriptor.hpp"
#include "cyclone_connections.h"
#include "dds/port/options_check.hpp"
#include "skein/error.hpp"

namespace skein::dds::cyclonedds {
namespace {

struct Guarded {
  ddsi_tran_read_fn_t read;
  std::shared_ptr<RtpsGuard> guard;
};

struct Registry {
  std::shared_mutex mutex;
  std::unordered_map<ddsi_tran_conn*, Guarded> connections;
};

Registry& registry() {
  static Registry* const only = new Registry;  // Cyclone's threads may outlive static objects
  return *only;
}

std::uint32_t address_of(const ddsi_locator_t& locator) {
  const unsigned char* at = locator.address + 12;
  return std::uint32_t{at[0]} << 24 | at[1] << 16 | at[2] << 8 | at[3];
}

/// Takes Cyclone's place: reads as it does, and lets nothing be seen of a packet that is refused.
ssize_t read_guarded(ddsi_tran_conn* connection, unsigned char* buffer, std::size_t size,
                     bool allow_spurious, ddsi_locator_t* source) {
  Guarded guarded;
  {
    const std::shared_lock lock(registry().mutex);
    guarded = registry().connections.at(connection);
  }
  ddsi_locator_t from{};
  const ssize_t got = guarded.read(connection, buffer, size, allow_spurious, &from);
  if (source != nullptr) *source = from;
  constexpr ssize_t kWakeUp = 1;  // what Cyclone sends itself when its threads are to end
  if (got <= kWakeUp) return got;
  const auto received = std::min(static_cast<std::size_t>(got), size);
  return static_cast<ssize_t>(
      guarded.guard->pass(buffer, received, address_of(from), RtpsGuard::Clock::now()).size);
}

/// A thread that waits in Cyclone's own function takes one more packet there: let it be this one,
/// an RTPS header with nothing behind it.
void wake_readers(const std::vector<ddsi_tran_conn*>& connections, const Network& network) {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  unsigned char message[rtps_message::kRtpsHeaderSize];
  rtps_message::put_header(message, Guid::random());
  sockaddr_in to{};
  to.sin_family = AF_INET;
  inet_pton(AF_INET, interface_addresses(network).front().c_str(), &to.sin_addr);
  for (const ddsi_tran_conn* connection : connections) {
    to.sin_port = htons(static_cast<std::uint16_t>(connection->m_base.m_port));
    sendto(socket.get(), message, sizeof message, 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
  }
}

}  // namespace

PacketGuard::PacketGuard(ddsi_domaingv& domain, const ParticipantOptions& options)
    : guard_(std::make_shared<RtpsGuard>(addresses_of(options.network), "dds/cyclonedds",
                                         SkippedNumbers::Noted)) {
  guarded_.resize(SKEIN_MOST_CONNECTIONS);
  guarded_.resize(skein_cyclone_connections(&domain, guarded_.data()));
  if (guarded_.empty()) {
    throw Internal("this Cyclone DDS is not of the version that the module was built for");
  }
  const std::lock_guard lock(registry().mutex);
  for (ddsi_tran_conn* connection : guarded_) {
    registry().connections[connection] = {connection->m_read_fn, guard_};
    // Its threads read already.
    std::atomic_ref(connection->m_read_fn).store(&read_guarded);
  }
  wake_readers(guarded_, options.network);
}

PacketGuard::~PacketGuard() {
  const std::lock_guard lock(registry().mutex);
  for (ddsi_tran_conn* connection : guarded_) registry().connections.erase(connection);
}

}  // namespace skein::dds::cyclonedds
