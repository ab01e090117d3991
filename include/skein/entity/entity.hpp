#pragma once

#include <memory>
#include <string>
#include <vector>

#include "skein/connector/connector.hpp"
#include "skein/core/thread_settings.hpp"
#include "skein/dds/port.hpp"
#include "skein/entity/head.hpp"
#include "skein/entity/process.hpp"
#include "skein/topics/publisher.hpp"
#include "skein/topics/subscription.hpp"

namespace skein::introspection {
struct ServiceStatistics;
}

namespace skein {

struct EntityOptions {
  std::string name{};
  /// The vehicle or station that the entity belongs to.
  std::string system = "default";
  /// The DDS implementation, `dds::load_vendor("cyclonedds")`.
  std::shared_ptr<dds::Vendor> vendor{};
  /// The mission: a DDS domain, 0 to 232.
  std::uint32_t domain = 0;
  /// Loopback alone by default.
  dds::Network network{};
  /// Shared by entities that are to call each other without leaving the process; none: its own.
  std::shared_ptr<Process> process{};
  /// How long a peer that is not heard of is trusted.
  std::chrono::milliseconds lease{1000};
  /// How long a thread that waits for the answer of a blocking call to another process looks for it
  /// before it sleeps: a wake-up saved for a processor spent.
  std::chrono::microseconds spin{0};
  /// How its Head decides.
  HeadOptions head{};
};

struct ServiceAttribute {
  std::string name;
  std::string value;
};

struct ServiceOptions {
  /// What the description declares: `latency` in ms, `quality`, ...
  std::vector<ServiceAttribute> attributes{};
  /// Threads that run this service's calls.
  std::size_t threads = 1;
  /// How the system runs these threads.
  ThreadSettings scheduling{};
  /// Requests that may wait for a thread, over all clients; others are refused as Overloaded. A
  /// client alone may have half of them waiting, several share: there is always room for one more
  /// client.
  std::size_t queue = 2048;
  /// The component description as XML, for those who look the service up.
  std::string component{};
  /// Managed interfaces for which the entity keeps CSPs.
  std::vector<std::string> subcomponents{};
};

/// An autonomous entity: a peer with one DDS participant, a Head that decides, Bodies that
/// implement its public services, and CSPs that implement its managed ones; it also publishes and
/// subscribes. Members are thread-safe. Publishers and subscriptions must be done with before the
/// entity is destroyed. Proxies, calls and streams may outlive it: they end with it (see ~Entity).
/// What it was given to provide it releases.
class Entity {
 public:
  /// Joins the mission. Throws what the port throws, InvalidArgument for a name that is none.
  explicit Entity(EntityOptions options);
  /// Ends its connections: calls and streams through them end as Disconnected, later calls as
  /// Unavailable. Withdraws everything, ends what runs, runs the continuations that are due,
  /// leaves. Not from one of them, nor from a call that it serves.
  ~Entity();

  const EntityOptions& options() const noexcept;
  /// `system/name`: how managed services name their owner.
  std::string id() const;

  /// Provides a public service: the Body. Clients get a session of the Head. Returns its identity.
  template <class Interface>
  Guid provide(std::shared_ptr<Interface> body, const ServiceOptions& options = {}) {
    return provide(skeleton_of(std::move(body)), options);
  }
  Guid provide(std::shared_ptr<Servant> servant, const ServiceOptions& options);

  /// Provides a CSP to its owner, `system/name` of an entity, and to nobody else. The owner may be
  /// this entity: then the CSP is called without leaving the process. `name` is the CSP's own.
  template <class Interface>
  Guid provide_csp(const std::string& name, const std::string& owner,
                   std::shared_ptr<Interface> csp, const ServiceOptions& options = {}) {
    return provide_csp(name, owner, skeleton_of(std::move(csp)), options);
  }
  Guid provide_csp(const std::string& name, const std::string& owner,
                   std::shared_ptr<Servant> servant, const ServiceOptions& options);

  /// Withdraws one service; calls that run end first. Unknown ones are no error.
  void withdraw(const Guid& provider);

  /// What the services that this entity provides have done, CSPs included: counters and latencies
  /// of each operation. "skein/introspection.idl.hpp" holds the type; `skein services --statistics`
  /// shows those of all entities.
  std::vector<introspection::ServiceStatistics> statistics() const;

  /// See Connector::connect.
  template <class Interface>
  typename Interface::Proxy connect(const ConnectOptions& options = {}) {
    return connector().connect<Interface>(options);
  }

  template <class Interface>
  typename Interface::Proxy connect(const Reference<Interface>& reference,
                                    const ConnectOptions& options = {}) {
    return connector().connect(reference, options);
  }

  /// See Connector::connect_all and gather().
  template <class Interface>
  std::vector<Connected<Interface>> connect_all(const ConnectOptions& options = {}) {
    return connector().connect_all<Interface>(options);
  }

  /// A reference to a service that this entity provides, to be passed to others.
  template <class Interface>
  Reference<Interface> reference(const Guid& provider) const {
    return Reference<Interface>(
        {std::string(Interface::interface_info().name), provider, options().name});
  }

  /// Publishes on the topic `name` of the entity's own system, unless `qos` names others.
  template <class T>
  Publisher<T> publisher(const std::string& name, const TopicQos& qos = {}) {
    return Publisher<T>(participant(), name, with_system(qos));
  }

  /// Subscribes to it. The callback runs on one thread for all subscriptions of the entity, or on
  /// an executor that `options` name; without a callback the user polls.
  template <class T>
  Subscription<T> subscription(const std::string& name, const TopicQos& qos = {},
                               typename Subscription<T>::Callback callback = nullptr,
                               SubscriptionOptions options = {}) {
    return Subscription<T>(participant(), topic_executor(), name, with_system(qos),
                           std::move(callback), std::move(options));
  }

  Connector& connector() noexcept;
  brokerless_discovery::Broker& broker() noexcept;
  Head& head() noexcept;
  Clock& clock() noexcept;
  dds::Participant& participant() noexcept;

 private:
  TopicQos with_system(TopicQos qos) const;
  Executor& topic_executor();

  struct Provided;
  struct State;

  template <class Interface>
  static std::shared_ptr<Servant> skeleton_of(std::shared_ptr<Interface> implementation) {
    return std::make_shared<typename Interface::Skeleton>(std::move(implementation));
  }
  Guid add(std::shared_ptr<Servant> servant, const ServiceOptions& options, const std::string& name,
           const std::string& owner);
  std::unique_ptr<State> state_;
};

}  // namespace skein
