#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skein/brokerless_discovery/broker.hpp"
#include "skein/brokerless_discovery/load_board.hpp"
#include "skein/connector/gather.hpp"
#include "skein/core/call.hpp"
#include "skein/idl/service_reference.hpp"
#include "skein/rpc/call_journal.hpp"
#include "skein/rpc/local_directory.hpp"

namespace skein {

namespace connector {
class Connections;
struct Link;
struct Wanted;
}  // namespace connector

using brokerless_discovery::Constraint;
using brokerless_discovery::Relation;

/// Where and how to connect. The defaults reach the least loaded provider of the interface in one's
/// own system; where all are idle, the first in the Broker's order.
struct ConnectOptions {
  /// An interface's or an entity's name; empty means the proxy's own interface.
  std::string name{};
  /// Another vehicle or station; kAnySystem for whichever.
  std::optional<std::string> system{};
  /// Only this provider, as a service reference names it; nil means any.
  Guid provider{};
  /// What the provider must declare: `{{"latency", Relation::AtMost, "300"}}`. Where no provider
  /// meets all, connect() says for each why it was passed over.
  std::vector<Constraint> constraints{};
  /// Providers on this host come first, others only where it has none: kOwnHost, or what a
  /// ServiceDescription calls its host.
  std::string preferred_host{};
  /// The Head's selection strategy for this session; empty means the provider's default.
  std::string strategy{};
  /// A call to an idempotent operation that has no answer after so long is made at a second
  /// provider, too, where one stands by; the first answer is taken, the other call cancelled.
  /// Nothing: never. Each such call then copies its in struct and its result.
  std::optional<Duration> hedge_after{};
  /// For finding a provider and opening the connection.
  Duration timeout = std::chrono::seconds(5);
  /// A server that is not built with Skein: no description tells of it, and it lives in the default
  /// partition of the interface's topics. `name`, where given, is the interface's.
  bool foreign = false;

  static constexpr const char* kAnySystem = "*";
  static constexpr const char* kOwnHost = ".";
};

/// The paper's connector: turns `connect(name)` into a typed proxy. Looks the name up in the
/// Broker's local table, chooses the lane (same process or DDS), opens the session and, when a
/// provider dies, connects to the next one. Thread-safe; connect() blocks and must not be called
/// from a listener.
class Connector {
 public:
  struct Parts {
    dds::Participant& participant;
    brokerless_discovery::Broker& broker;
    const brokerless_discovery::LoadBoard& loads;
    std::shared_ptr<rpc::LocalDirectory> directory;
    Executor& control;
    std::shared_ptr<Executor> continuations;
    std::shared_ptr<Clock> clock;
    std::chrono::microseconds spin{0};            ///< See EntityOptions.
    std::shared_ptr<rpc::CallJournal> journal{};  ///< May be null.
  };

  /// The parts stand until close() has returned.
  explicit Connector(const Parts& parts);

  /// Ends every connection that was made, by whichever copy of the connector, though others still
  /// hold proxies, calls and streams: what is pending ends as Disconnected, what comes later as
  /// Unavailable.
  void close();

  /// A proxy of the wanted interface, ready for calls. Throws Unavailable with the reason where
  /// there is no provider in time, InvalidArgument for an ambiguous name, what the Head throws to
  /// refuse.
  template <class Interface>
  typename Interface::Proxy connect(const ConnectOptions& options = {}) {
    return typename Interface::Proxy(open(Interface::interface_info(), options));
  }

  /// The same for a service reference that came as a parameter or a result: exactly that provider,
  /// in whichever system. Throws InvalidArgument for a nil reference.
  template <class Interface>
  typename Interface::Proxy connect(const Reference<Interface>& reference,
                                    ConnectOptions options = {}) {
    return typename Interface::Proxy(
        open(Interface::interface_info(), to(reference, std::move(options))));
  }

  /// A proxy for each provider that matches now, in the Broker's order, for gather(). Each stays
  /// with its provider; one that does not answer is left out. Throws as connect() does where none
  /// is left.
  template <class Interface>
  std::vector<Connected<Interface>> connect_all(const ConnectOptions& options = {}) {
    std::vector<Connected<Interface>> all;
    for (Opened& opened : open_all(Interface::interface_info(), options)) {
      all.push_back({opened.provider, std::move(opened.entity),
                     typename Interface::Proxy(std::move(opened.channel))});
    }
    return all;
  }

  /// The connection without its type: each call goes to the provider connected now; a lost one is
  /// replaced by the next at the next call. A call to an operation that IDL declares idempotent,
  /// and whose provider is lost (Disconnected) or refuses it (Unavailable, Overloaded), is made
  /// again at the next provider that stands by, within its deadline; without one it ends as it
  /// would have ended.
  std::shared_ptr<Channel> open(const InterfaceInfo& interface, const ConnectOptions& options);

  /// One connection to exactly this provider, without replacement.
  std::shared_ptr<Channel> open_provider(const brokerless_discovery::ServiceDescription& provider,
                                         const std::string& strategy, Duration timeout) const;

 private:
  struct Opened {
    Guid provider;
    std::string entity;
    std::shared_ptr<Channel> channel;
  };

  std::vector<Opened> open_all(const InterfaceInfo& interface, const ConnectOptions& options) const;
  static ConnectOptions to(const ServiceReference& reference, ConnectOptions options);
  std::shared_ptr<Channel> open_foreign(const InterfaceInfo& interface,
                                        const ConnectOptions& options) const;
  brokerless_discovery::Query query(const InterfaceInfo& interface,
                                    const ConnectOptions& options) const;
  connector::Link open_link(const brokerless_discovery::ServiceDescription& provider,
                            const std::string& strategy, Duration timeout) const;
  connector::Link open_next(const brokerless_discovery::Query& query, const std::string& strategy,
                            const connector::Wanted& wanted) const;

  Parts parts_;
  std::shared_ptr<connector::Connections> connections_;
};

}  // namespace skein
