#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "call_port/call_port.hpp"
#include "core/recent_set.hpp"
#include "meeting.hpp"
#include "receiver.hpp"

namespace skein::same_host {

/// What ProviderPort and ClientPort have in common.
struct PortOptions {
  /// The DDS participant in whose name the endpoints speak: their identities begin with its.
  Guid participant;
  /// See SpinPolicy.
  std::chrono::microseconds spin{0};
};

/// Gives out identities of endpoints that no DDS endpoint of the participant has. Thread-safe.
class EndpointIdentities {
 public:
  explicit EndpointIdentities(const Guid& participant) : participant_(participant) {}
  Guid next();

 private:
  const Guid participant_;
  std::atomic<std::uint32_t> last_{0};
};

/// The provider's side of calls between processes of one host. Listeners run inside
/// send_replies(), or on a thread that each receiver has for itself from its first client on,
/// `skein-requests`: what takes long there holds up no other receiver. Calls of a receiver's
/// listener for different clients may overlap.
class ProviderPort final : public calls::ProviderPort {
 public:
  /// `meeting` outlives it.
  ProviderPort(Meeting& meeting, const PortOptions& options);
  ~ProviderPort() override;

  /// Clients that are not built with Skein do not come here.
  std::unique_ptr<calls::Receiver> receive_requests(const calls::Address& address, bool foreign,
                                                    calls::Listener listener) override;
  /// Nobody is found if the client has left; what is sent then is dropped.
  std::unique_ptr<calls::Sender> send_replies(const calls::Address& address, const Guid& client,
                                              calls::PeerListener on_peer = {}) override;

 private:
  class RequestReceiver;
  void add(const std::shared_ptr<Link>& link);
  std::shared_ptr<Link> find(const Guid& client);

  Meeting& meeting_;
  const PortOptions options_;
  EndpointIdentities identities_;
  std::mutex mutex_;
  std::map<Guid, std::weak_ptr<Link>> links_;  // by client
};

/// The client's side. Listeners run on one thread, `skein-replies`, on those that wait by
/// CallerDelivery, or inside send_requests(). The connection ends with its sender.
class ClientPort final : public calls::ClientPort {
 public:
  /// `meeting` outlives it.
  ClientPort(Meeting& meeting, const PortOptions& options);
  ~ClientPort() override;

  /// Blocks for as long as Meeting::join(). Throws Unavailable with the reason if the provider is
  /// not reached in this way, or has damaged what it shares before.
  std::unique_ptr<calls::Sender> send_requests(const calls::Address& address,
                                               calls::PeerListener on_peer,
                                               std::function<void()> on_full = {}) override;
  std::unique_ptr<calls::Receiver> receive_replies(const calls::Address& address,
                                                   const Guid& client,
                                                   calls::Listener listener) override;

 private:
  class ReplyReceiver;
  struct Connection {
    std::weak_ptr<Link> link;
    Guid provider;
  };
  void note_end(const Link& link);

  Meeting& meeting_;
  const PortOptions options_;
  EndpointIdentities identities_;
  std::mutex mutex_;
  std::map<Guid, Connection> connections_;  // by client
  RecentSet<Guid> distrusted_{1024};        // providers
  Receiver receiver_;
};

/// What an entity needs to offer and to call services between processes of its host.
struct CallPorts {
  explicit CallPorts(const PortOptions& options)
      : providers(meeting, options), clients(meeting, options) {}

  Meeting meeting;
  ProviderPort providers;
  ClientPort clients;
};

}  // namespace skein::same_host
