#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "skein/clock.hpp"
#include "skein/connector.hpp"
#include "skein/constraint.hpp"
#include "skein/detail/circuit_breaker.hpp"
#include "skein/detail/operation.hpp"
#include "skein/executor.hpp"
#include "skein/guid.hpp"
#include "skein/process.hpp"
#include "skein/topics.hpp"
#include "skein/vendor.hpp"

namespace skein::brokerless_discovery {
class Broker;
}
namespace skein::introspection {
struct ServiceStatistics;
}

namespace skein {

class SelectionStrategy;
struct Candidate;
class Head;

/// How a Head decides. A mission profile sets all fields but `strategies`, which its plugins add,
/// and `on_hang`.
struct HeadOptions {
  /// Strategy for requests whose session names none.
  std::string strategy = "declared";
  /// Strategies in addition to Skein's own; `strategy` may name one of them.
  std::vector<std::shared_ptr<const SelectionStrategy>> strategies{};
  /// File of the history: read at the start if it exists, written at the end. Empty: none.
  std::string history{};
  /// File to which each decision is appended as a line of JSON; at 64 MiB `x.jsonl` becomes
  /// `x.1.jsonl`, in place of an earlier one. Empty: none.
  std::string log{};
  /// Share of decisions in which `learned` may try a CSP only to learn about it.
  double exploration = 0.02;
  CircuitBreaker::Rules breaker{};
  /// The peer is degraded if this many CSPs in its process do not return.
  std::size_t max_stuck = 3;
  /// Called on the performing thread when a CSP in another process has timed out after at least
  /// four times its expected time. The CSP is quarantined; its launcher may restart it. Must return
  /// soon.
  std::function<void(const Candidate&)> on_hang{};
};

struct EntityOptions {
  /// Letters, digits, `_`, `-` and `.`; the same for `system`.
  std::string name{};
  /// The vehicle or station to which the entity belongs.
  std::string system = "default";
  /// The DDS implementation; required: `dds::load_vendor("cyclonedds")`.
  dds::VendorPointer vendor{};
  /// The DDS domain of the mission, 0 to 232.
  std::uint32_t domain = 0;
  /// By default 127.0.0.1 only.
  dds::Network network{};
  /// Share one among entities that are to call each other without leaving the process. nullptr: the
  /// entity makes its own.
  std::shared_ptr<Process> process{};
  /// A peer that is not heard of for this time is no longer trusted; at least 20 ms. Use the same
  /// value in all entities of a mission: an entity does not find the services of peers with a
  /// longer lease.
  std::chrono::milliseconds lease{1000};
  /// How long a thread that waits in a blocking call to another process polls for the answer before
  /// it sleeps. Polling saves a wake-up and costs CPU time.
  std::chrono::microseconds spin{0};
  /// How the Head decides.
  HeadOptions head{};
  /// Changes what publishers and subscriptions of the topic `name` ask for. Called for each of them
  /// on the thread that makes it, which an exception from it goes to.
  std::function<void(const std::string& name, TopicQos& qos)> adjust_topic{};
  /// Whether calls to and from entities of other processes on this host go through shared memory,
  /// where those do so, too; all others, and those that find no way there, go over DDS. By default
  /// they do, but on a network inside the process.
  std::optional<bool> shared_memory_calls{};
};

struct ServiceAttribute {
  std::string name;
  brokerless_discovery::AttributeValue value;
};

struct ServiceOptions {
  /// What the service declares: `latency` (in ms, or with a unit: `0.3 s`), `quality`, ... A name
  /// that misses one of these two by a letter is logged.
  std::vector<ServiceAttribute> attributes{};
  /// Where blocking calls from the same process run; all others run on the service's own threads.
  /// With CallThread::Caller, calls run one at a time, and `threads` is 1.
  CallThread thread = CallThread::Own;
  /// Number of own threads that run this service's calls; 1 or more.
  std::size_t threads = 1;
  /// Scheduling of these threads.
  ThreadSettings scheduling{};
  /// Capacity of the request queue, 1 or more, for all clients together; further requests are
  /// refused as Overloaded. So is a request of a peer that has as many waiting as there are free
  /// places: a single peer fills at most half of the queue, and there is always room for a new one.
  /// As many calls again may be begun and not answered yet, where the implementation answers later.
  std::size_t queue = 2048;
  /// The component description as XML, for clients that look the service up.
  std::string component{};
  /// Managed interfaces for which the entity uses CSPs.
  std::vector<std::string> subcomponents{};
};

/// What is taken as an implementation of `Interface`, whatever it lacks.
template <class Given, class Interface>
concept Implementation = std::is_convertible_v<Given, std::shared_ptr<Interface>> ||
    requires(Given&& given, void (&take)(std::shared_ptr<typename Interface::Deferred>)) {
  take(std::forward<Given>(given));
};

/// One of a class that nobody can make an object of.
template <class Given, class Interface>
concept AbstractImplementation = Implementation<Given, Interface> && requires {
  typename std::remove_cvref_t<Given>::element_type;
  requires std::is_abstract_v<typename std::remove_cvref_t<Given>::element_type>;
  requires !std::is_same_v<typename std::remove_cvref_t<Given>::element_type, Interface>;
  requires !std::is_same_v<typename std::remove_cvref_t<Given>::element_type,
                           typename Interface::Deferred>;
};

/// What cannot be provided as an implementation of `Interface`.
template <class Given, class Interface>
concept NoImplementation =
    !Implementation<Given, Interface> || AbstractImplementation<Given, Interface>;

/// Says in words why it cannot, and which other arguments are wrong. A type, not a function: the
/// compiler looks at the types of a call before it compiles the functions that the arguments call,
/// such as a make_shared() of an abstract class, of which it says some fifty lines.
template <class Given, class Interface, class Name = std::string, class Owner = std::string>
struct Refused {
  static constexpr bool kNamed =
      std::is_convertible_v<Name, std::string> && std::is_convertible_v<Owner, std::string>;
  static constexpr bool kFits = !kNamed || Implementation<Given, Interface>;
  static constexpr bool kShared = requires(Given & given) { given.use_count(); };
  static_assert(kNamed,
                "provide_csp() takes the CSP's name, its owner's Entity::id(), the "
                "implementation, and options: "
                "provide_csp<INTERFACE>(\"AStar\", entity.id(), csp)");
  static_assert(kFits || kShared,
                "an implementation is given as a std::shared_ptr: "
                "provide<INTERFACE>(std::make_shared<YOUR_CLASS>())");
  static_assert(kFits || !kShared,
                "this class does not implement the interface: derive it, publicly, from INTERFACE, "
                "or from INTERFACE::Deferred if it answers later");
  static_assert(!kNamed || !AbstractImplementation<Given, Interface>,
                "this class lacks an operation of the interface, or has it with other parameters: "
                "the compiler lists it below as pure. If it is a base of the class that has all, "
                "give a std::shared_ptr<INTERFACE>");
  using type = Guid;
};

/// An autonomous entity: a peer with one DDS participant, a Head that decides, Bodies that
/// implement its public services, and CSPs that implement its managed ones; it can also publish and
/// subscribe. Thread-safe. Destroy publishers and subscriptions before the entity; otherwise the
/// program may abort. Proxies, calls and streams may outlive it (see ~Entity). The entity releases
/// the implementations that it provided.
///
/// ```cpp
/// skein::Entity guest({.name = "guest", .vendor = skein::dds::load_vendor(vendor)});
/// auto greeter = guest.connect<greeting::IGreeter>();
/// std::puts(greeter.greet("world").c_str());
/// ```
class Entity {
 public:
  /// Joins the mission. Throws InvalidArgument for an invalid name or option, and what
  /// Vendor::create_participant() throws.
  explicit Entity(EntityOptions options);
  /// Ends all connections: pending calls and streams end as Disconnected, later calls as
  /// Unavailable. Withdraws all services, stops running calls, runs the continuations that are due,
  /// and leaves the mission. Waits at most 2 s in all for calls that hang; their threads are left
  /// behind, and what these calls return, should they ever, goes nowhere. While a Body hangs, the
  /// entity stays in the mission, without services: the Body may use the Head. Do not destroy an
  /// entity from one of its continuations or from a call that it serves.
  ~Entity();

  const EntityOptions& options() const noexcept;
  /// `system/name`, by which managed services name their owner.
  std::string id() const;
  /// Identity of its DDS participant. The GUIDs of all its writers begin with the same 12 bytes.
  Guid guid() const;

  /// Provides a public service, implemented by a Body. Each client gets a session of the Head.
  /// Returns the provider's identity. Provided twice, an interface has two providers of the same
  /// name, among which clients choose as among any others. Throws InvalidArgument for options that
  /// cannot work.
  template <class Interface>
  Guid provide(std::shared_ptr<Interface> body, const ServiceOptions& options = {}) {
    return provide(skeleton_of(std::move(body)), options);
  }
  /// A Body that answers later: see Reply.
  template <class Interface>
  Guid provide(std::shared_ptr<typename Interface::Deferred> body,
               const ServiceOptions& options = {}) {
    return provide(std::shared_ptr<Servant>(std::move(body)), options);
  }
  Guid provide(std::shared_ptr<Servant> servant, const ServiceOptions& options);
  /// Refuses in words what implements no `Interface`.
  template <class Interface, NoImplementation<Interface> Given>
  typename Refused<Given, Interface>::type provide(Given&&, const ServiceOptions& = {});

  /// Provides a CSP to its owner, `system/name` of an entity, and to nobody else. If the owner is
  /// this entity, the CSP is called without leaving the process. `name` is the CSP's, not the
  /// entity's; an entity cannot provide two CSPs of the same name, interface and owner. Returns and
  /// throws as provide() does.
  template <class Interface>
  Guid provide_csp(const std::string& name, const std::string& owner,
                   std::shared_ptr<Interface> csp, const ServiceOptions& options = {}) {
    return provide_csp(name, owner, skeleton_of(std::move(csp)), options);
  }
  template <class Interface>
  Guid provide_csp(const std::string& name, const std::string& owner,
                   std::shared_ptr<typename Interface::Deferred> csp,
                   const ServiceOptions& options = {}) {
    return provide_csp(name, owner, std::shared_ptr<Servant>(std::move(csp)), options);
  }
  Guid provide_csp(const std::string& name, const std::string& owner,
                   std::shared_ptr<Servant> servant, const ServiceOptions& options);
  /// Refuses in words what implements no `Interface`, and other arguments than these.
  template <class Interface, class Name, class Owner, class Given>
  requires(NoImplementation<Given, Interface> || !std::is_convertible_v<Name, std::string> ||
           !std::is_convertible_v<Owner, std::string>)
      typename Refused<Given, Interface, Name, Owner>::type
      provide_csp(Name&&, Owner&&, Given&&, const ServiceOptions& = {});

  /// Withdraws one service of this entity. Queued calls are refused; running calls are told to
  /// stop, and awaited for up to 2 s; what those that hang return later goes nowhere. Other
  /// providers' identities and unknown ones are ignored. Do not call it from a call of that
  /// service.
  void withdraw(const Guid& provider);

  /// Withdraws all services without loss, so that nobody's call fails if there is another provider,
  /// or comes one within the call's deadline: tells clients to go elsewhere, serves what they had
  /// sent until then, Bodies first, and withdraws a service when its clients have left it. After
  /// `patience` it withdraws the rest as withdraw() does, and returns false. Peers that are not
  /// built with Skein are not told; their new calls are refused as Unavailable. Blocks; not from a
  /// call of these services.
  bool drain(TimeSpan patience);

  /// Counters and latencies of each operation of the services that this entity provides, CSPs
  /// included. "skein/introspection.idl.hpp" defines the type; `skein services --statistics` shows
  /// those of all entities.
  std::vector<introspection::ServiceStatistics> statistics() const;

  /// Calls `report` on the entity's control thread, and so not as long as that thread hangs: with
  /// what makes no progress, in words (a service all of whose threads are in calls whose deadlines
  /// are over, a Head that is degraded), or with an empty text. Returns false, and never calls it,
  /// if that thread has too much to do.
  bool check_progress(std::function<void(const std::string& stuck)> report);

  /// See Connector::connect.
  template <class Interface>
  typename ProxyOf<Interface>::type connect(const ConnectOptions& options = {}) {
    return connector().connect<Interface>(options);
  }

  template <class Interface>
  typename ProxyOf<Interface>::type connect(const Reference<Interface>& reference,
                                            const ConnectOptions& options = {}) {
    return connector().connect(reference, options);
  }

  template <class Interface, WrongConnectArgument<Interface> Given>
  typename ProxyOf<Interface>::type connect(Given&&) {
    refuse_connect_argument<Given>();
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

  /// Publishes on the topic `name`, in the entity's own system unless `qos` names others, and with
  /// what EntityOptions::adjust_topic changes. Throws InvalidArgument for an invalid name or QoS,
  /// and for a name that the entity already uses with another type.
  template <class T>
  Publisher<T> publisher(const std::string& name, const TopicQos& qos = {}) {
    return Publisher<T>(topic_writer(name, topics::topic_type<T>(), qos));
  }

  /// Subscribes to the topic `name`, likewise. The callback runs on one thread for all
  /// subscriptions of the entity, or on the executor in `options`. Without a callback the user
  /// polls.
  template <class T>
  Subscription<T> subscription(const std::string& name, const TopicQos& qos = {},
                               typename Subscription<T>::Callback callback = nullptr,
                               const SubscriptionOptions& options = {}) {
    return Subscription<T>(topic_reader(name, topics::topic_type<T>(), qos,
                                        topics::consumer_of(std::move(callback)), options));
  }

  Connector& connector() noexcept;
  /// For Skein's own tools: its header is not installed.
  brokerless_discovery::Broker& broker() noexcept;
  Head& head() noexcept;
  Clock& clock() noexcept;

 private:
  friend struct EntityAccess;
  struct Provided;
  struct State;

  std::unique_ptr<topics::TopicWriter> topic_writer(const std::string& name,
                                                    const topics::TopicType& type,
                                                    const TopicQos& qos);
  std::unique_ptr<topics::TopicReader> topic_reader(const std::string& name,
                                                    const topics::TopicType& type,
                                                    const TopicQos& qos,
                                                    topics::TopicReader::Consumer consumer,
                                                    SubscriptionOptions options);
  bool drain_some(bool managed, Instant deadline);

  template <class Interface>
  static std::shared_ptr<Servant> skeleton_of(std::shared_ptr<Interface> implementation) {
    static_assert(
        requires { typename Interface::Skeleton; },
        "only an IDL interface is provided; values of a struct or union are published on "
        "a topic: Entity::publisher()");
    if (!implementation) return nullptr;
    return std::make_shared<typename Interface::Skeleton>(std::move(implementation));
  }
  Guid add(std::shared_ptr<Servant> servant, const ServiceOptions& options, const std::string& name,
           const std::string& owner);
  void refuse_second_csp(const InterfaceInfo& interface, const std::string& name,
                         const std::string& owner) const;
  std::unique_ptr<State> state_;
};

}  // namespace skein
