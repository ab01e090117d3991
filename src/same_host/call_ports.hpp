#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "core/recent_set.hpp"
#include "dds/port/port.hpp"
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

/// The port to DDS as a provider of calls uses it, between processes of one host: its readers take
/// requests, its writers each write the replies to one client. What is read and written are the
/// same bytes as over DDS, reliable, in order, and for who is connected now. A reader offers itself
/// to clients under each of its partitions but "", which must be the identity of a provider; a
/// writer's partition must be the identity of a client's writer. Listeners run inside
/// create_writer(), or on a thread that each reader has for itself from its first client on,
/// `skein-requests`: what takes long there holds up no other reader. Calls of a reader's listener
/// for different clients may overlap.
class ProviderPort final : public dds::Participant {
 public:
  /// `meeting` outlives it.
  ProviderPort(Meeting& meeting, const PortOptions& options);
  ~ProviderPort() override;

  /// Throws Unavailable where the kernel refuses what is needed.
  std::unique_ptr<dds::Reader> create_reader(const dds::Topic& topic, const dds::Qos& qos,
                                             dds::ReaderListener listener) override;
  /// Nobody is matched where the client has left.
  std::unique_ptr<dds::Writer> create_writer(const dds::Topic& topic, const dds::Qos& qos,
                                             dds::WriterListener listener) override;
  Guid guid() const override { return options_.participant; }

 private:
  class RequestReader;
  void add(const std::shared_ptr<Link>& link);
  std::shared_ptr<Link> find(const Guid& client);

  Meeting& meeting_;
  const PortOptions options_;
  EndpointIdentities identities_;
  std::mutex mutex_;
  std::map<Guid, std::weak_ptr<Link>> links_;  // by client
};

/// The same for who calls: a writer writes requests to the provider that its partition names, and
/// connects to it; a reader's partition must be the identity of such a writer, whose replies it
/// takes. Listeners run on one thread, `skein-replies`, on those that wait by CallerDelivery, or
/// inside create_writer(). The connection ends with its writer.
class ClientPort final : public dds::Participant {
 public:
  ClientPort(Meeting& meeting, const PortOptions& options);
  ~ClientPort() override;

  std::unique_ptr<dds::Reader> create_reader(const dds::Topic& topic, const dds::Qos& qos,
                                             dds::ReaderListener listener) override;
  /// Blocks for as long as Meeting::join(). Throws Unavailable with the reason where the provider
  /// is not reached in this way, or has damaged what it shares before.
  std::unique_ptr<dds::Writer> create_writer(const dds::Topic& topic, const dds::Qos& qos,
                                             dds::WriterListener listener) override;
  Guid guid() const override { return options_.participant; }

 private:
  class ReplyReader;
  struct Connection {
    std::weak_ptr<Link> link;
    Guid provider;
  };
  void note_end(const Link& link);

  Meeting& meeting_;
  const PortOptions options_;
  EndpointIdentities identities_;
  std::mutex mutex_;
  std::map<Guid, Connection> connections_;  // by the writer's identity
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
