#pragma once

#include <string>

#include "call_port.hpp"
#include "dds/port/port.hpp"

namespace skein::calls {

/// DDS-RPC's topics of an interface, which peers that are not built with Skein use, too.
dds::Topic request_topic(const Address& address);
dds::Topic reply_topic(const Address& address);
/// The partition in which a peer receives; nil: the default one, of peers without Skein.
std::string partition_of(const Guid& peer);

/// Calls over DDS. A provider receives in the partition that its identity names, a client in a
/// partition of its own; peers that are not built with Skein use the default partition.
class DdsCallPort final : public ProviderPort, public ClientPort {
 public:
  /// `participant` outlives the port.
  explicit DdsCallPort(dds::Participant& participant) : participant_(participant) {}

  std::unique_ptr<Receiver> receive_requests(const Address& address, bool foreign,
                                             Listener listener) override;
  std::unique_ptr<Sender> send_replies(const Address& address, const Guid& client,
                                       PeerListener on_peer = {}) override;
  std::unique_ptr<Sender> send_requests(const Address& address, PeerListener on_peer,
                                        std::function<void()> on_full = {}) override;
  std::unique_ptr<Receiver> receive_replies(const Address& address, const Guid& client,
                                            Listener listener) override;

 private:
  dds::Participant& participant_;
};

}  // namespace skein::calls
