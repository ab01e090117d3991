#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "skein/call.hpp"
#include "skein/clock.hpp"
#include "skein/constraint.hpp"
#include "skein/detail/channel.hpp"
#include "skein/detail/service_reference.hpp"
#include "skein/guid.hpp"

namespace skein::brokerless_discovery {
struct Query;
}  // namespace skein::brokerless_discovery
namespace skein::discovery {
struct ServiceDescription;
}

namespace skein {

namespace connector {
class Connections;
struct ProviderConnection;
struct ProviderQuery;
}  // namespace connector

using brokerless_discovery::Constraint;
using brokerless_discovery::Relation;

/// `Interface::Proxy`, for those who take a struct for an interface.
template <class Interface>
struct ProxyOf {
  static_assert(
      requires { typename Interface::Proxy; },
      "only an IDL interface is connected to; values of a struct or union are published "
      "on a topic: Entity::publisher() and Entity::subscription()");
  using type = typename Interface::Proxy;
};

/// Which provider to connect to, and how. The defaults choose among the providers of the interface
/// in the entity's own system: of two taken at random the one with less load; if all have the same
/// load, the first in the Broker's order (by entity name).
struct ConnectOptions {
  /// Name of an interface or an entity; empty: the proxy's own interface.
  std::string name{};
  /// Another vehicle or station; kAnySystem: any. Unset: the entity's own system.
  std::optional<std::string> system{};
  /// Only this provider, as a service reference names it; nil: any.
  Guid provider{};
  /// Attributes that the provider must declare: `{{"latency", Relation::AtMost, "300"}}`. If no
  /// provider meets all, the error of connect() gives the reason for each.
  std::vector<Constraint> constraints{};
  /// Providers on this host are preferred; others are used only if it has none. kOwnHost, or the
  /// host's name in a ServiceDescription. Empty: no preference.
  std::string preferred_host{};
  /// Selection strategy of the provider's Head for this session; empty: its default.
  std::string strategy{};
  /// Hedging: a call of an idempotent operation that has no answer after this time is also made at
  /// a second provider, if one is available. The first answer is used, the other call cancelled.
  /// Unset: no hedging. A warning is logged if the interface has no such operation. Each such call
  /// copies its in struct and its result. Hedges, and repeats of calls that a full provider
  /// refused, are at most 5 for a connection, and one for 16 of its calls; a repeat that another
  /// provider answers does not count.
  std::optional<TimeSpan> hedge_after{};
  /// Timeout for finding a provider and opening the connection, more than 0. Calls have their own
  /// timeout.
  TimeSpan timeout = std::chrono::seconds(5);
  /// Connect to a server that is not built with Skein. It has no description, and uses the default
  /// partition of the interface's topics. `name`, if set, is the interface's; of the other options
  /// only `timeout` applies.
  bool foreign = false;

  static constexpr const char* kAnySystem = "*";
  static constexpr const char* kOwnHost = ".";
};

/// What is given to connect() where neither ConnectOptions nor a reference to the interface is.
template <class Given, class Interface>
concept WrongConnectArgument = !std::is_convertible_v<Given, ConnectOptions> &&
                               !std::is_convertible_v<Given, Reference<Interface>>;

/// Refuses it in words.
template <class Given>
[[noreturn]] void refuse_connect_argument() {
  static_assert(std::is_void_v<Given>,
                "connect() takes its options in braces, connect<INTERFACE>({.name = \"rover\", "
                ".timeout = 2s}), or a Reference<INTERFACE>");
}

/// One of several providers, with a connection to it alone (see Connector::connect_all).
template <class Interface>
struct Connected {
  Guid provider;
  std::string entity;
  typename ProxyOf<Interface>::type proxy;
};

/// The connector of Oswald's architecture (2004): connect() returns a typed proxy. It looks
/// `ConnectOptions::name` up in the Broker's local table, chooses the transport (same process,
/// shared memory or DDS), opens the session, and connects to another provider if the current one is
/// lost. Thread-safe. connect() blocks; do not call it from a timer's action.
class Connector {
 public:
  struct Parts;

  /// Used by Entity. What `parts` refers to must exist until close() has returned.
  explicit Connector(const Parts& parts);
  Connector(const Connector&) = default;  // also in place of a move: none is without its parts
  Connector& operator=(const Connector&) = delete;

  /// Ends all connections of this connector and its copies, even if others still hold proxies,
  /// calls or streams: pending calls end as Disconnected, later ones as Unavailable.
  void close();

  /// Returns a proxy that is ready for calls. If a provider refuses the session as Unavailable or
  /// Overloaded, or does not answer, the next one is tried. Throws Unavailable with the reason if
  /// no provider is found in time, the last refusal if all refuse, InvalidArgument for an ambiguous
  /// name or an impossible constraint, and any other error with which a Head refuses.
  template <class Interface>
  typename ProxyOf<Interface>::type connect(const ConnectOptions& options = {}) {
    return typename Interface::Proxy(open(Interface::interface_info(), options));
  }

  /// Connects to exactly the provider of a service reference, in any system. Throws InvalidArgument
  /// for a nil reference.
  template <class Interface>
  typename ProxyOf<Interface>::type connect(const Reference<Interface>& reference,
                                            const ConnectOptions& options = {}) {
    return typename Interface::Proxy(open(Interface::interface_info(), to(reference, options)));
  }

  template <class Interface, WrongConnectArgument<Interface> Given>
  typename ProxyOf<Interface>::type connect(Given&&) {
    refuse_connect_argument<Given>();
  }

  /// Returns a proxy for each provider that matches now, in the Broker's order, for gather(). Each
  /// proxy stays with its provider. A provider that refuses, or does not answer within 1 s, is left
  /// out; throws as connect() does if none is left. `hedge_after` and `foreign` are ignored.
  template <class Interface>
  std::vector<Connected<Interface>> connect_all(const ConnectOptions& options = {}) {
    std::vector<Connected<Interface>> all;
    for (Opened& opened : open_all(Interface::interface_info(), options)) {
      all.push_back({opened.provider, std::move(opened.entity),
                     typename Interface::Proxy(std::move(opened.channel))});
    }
    return all;
  }

  /// The connection without its type. Each call goes to the current provider; if that is lost or
  /// suspect, the next call connects to another one. A call of an idempotent operation is retried
  /// within its deadline: once, at the next provider that is or becomes available, if its provider
  /// is lost (Disconnected); at 3 others that are available if providers refuse it (Unavailable,
  /// Overloaded). Then it ends with the last provider's error.
  std::shared_ptr<Channel> open(const InterfaceInfo& interface, const ConnectOptions& options);

  /// What is connected now.
  std::vector<ConnectionInfo> connections() const;

  /// Used by Head: one connection to exactly this provider, without fail-over. Throws Unavailable
  /// if it does not answer within `timeout`, or the error with which it refuses.
  std::shared_ptr<Channel> open_provider(const discovery::ServiceDescription& provider,
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
  connector::ProviderConnection open_connection(const discovery::ServiceDescription& provider,
                                                const std::string& strategy,
                                                Duration timeout) const;
  connector::ProviderConnection open_next(const brokerless_discovery::Query& query,
                                          const std::string& strategy,
                                          const connector::ProviderQuery& wanted) const;

  std::shared_ptr<const Parts> parts_;
  std::shared_ptr<connector::Connections> connections_;
};

}  // namespace skein
