#include "skein/connector.hpp"

#include <algorithm>
#include <optional>
#include <random>

#include "brokerless_discovery/broker.hpp"
#include "brokerless_discovery/load_board.hpp"
#include "brokerless_discovery/process_watch.hpp"
#include "brokerless_discovery/versions.hpp"
#include "connections.hpp"
#include "connector_parts.hpp"
#include "core/log.hpp"
#include "core/system/interface_name.hpp"
#include "failover_channel.hpp"
#include "rpc/client/local_channel.hpp"
#include "rpc/client/remote_channel.hpp"
#include "rpc/service/call_journal.hpp"
#include "rpc/service/local_directory.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

using brokerless_discovery::Change;
using brokerless_discovery::Query;
using brokerless_discovery::ServiceDescription;
using brokerless_discovery::Table;
using connector::Connections;
using connector::FailoverChannel;
using connector::NoProvider;
using connector::ProviderConnection;
using connector::ProviderQuery;

std::string peer_name(const ServiceDescription& provider) {
  return scoped_interface_name(provider.service) + " of " + provider.entity + " (" +
         provider.system + ")";
}

Representation representation_of(const ServiceDescription& provider) {
  return provider.xcdr2 ? Representation::Xcdr2Plain : Representation::Xcdr1;
}

// How long one provider may take to answer `open`, as there are others, or may soon be.
constexpr std::chrono::milliseconds kOpenPatience{1000};
constexpr std::chrono::milliseconds kRetryPause{20};

constexpr const char* kLeaving = "it was about to leave";

Instant deadline_of(const ConnectOptions& options, const Clock& clock) {
  if (options.timeout > Duration::zero()) return clock.after(options.timeout);
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(options.timeout).count();
  throw Unavailable("connect() has a `timeout` of " + std::to_string(ms) +
                    " ms, in which no provider can be found; give it some time, as 5s");
}

void tell_useless_hedging(const InterfaceInfo& interface, const ConnectOptions& options) {
  if (!options.hedge_after ||
      std::ranges::any_of(interface.operations, &OperationInfo::idempotent)) {
    return;
  }
  log(LogLevel::Warning, "connector",
      "`hedge_after` has no effect: no operation of " +
          scoped_interface_name(std::string(interface.name)) +
          " is declared @idempotent, and no other one is called twice");
}

const char* ending_of(brokerless_discovery::Departure departure) {
  switch (departure) {
    case brokerless_discovery::Departure::Left:
      return "it withdrew its service";
    case brokerless_discovery::Departure::Lost:
      return "it was not heard of for longer than its lease";
    case brokerless_discovery::Departure::Died:
      break;
  }
  return "its process ended";
}

// The kernel and the Broker know of a provider's end, or of its silence, before DDS does.
void follow(brokerless_discovery::Broker& broker,
            const std::shared_ptr<rpc::RemoteChannel>& channel,
            const ProviderConnection& connection) {
  using brokerless_discovery::Broker;
  auto registration = std::make_shared<Broker::Registration>(
      broker.observe([weak = std::weak_ptr(channel), provider = connection.provider,
                      suspect = connection.suspect](const Change& change) {
        if (change.description->provider != provider.bytes) return;
        const auto followed = weak.lock();
        if (change.kind == Change::Kind::Removed) {
          if (followed) followed->lose(ending_of(change.departure));
        } else if (brokerless_discovery::is_leaving(*change.description)) {
          if (followed) followed->retire(kLeaving);
        } else {
          *suspect = change.kind == Change::Kind::Suspect;
        }
      }));
  channel->attach(registration);
  // It may have gone between the answer to `open` and the first look.
  if (!broker.knows(connection.provider)) channel->lose("it ended while it was being connected");
  if (broker.is_leaving(connection.provider)) channel->retire(kLeaving);
}

bool contains_provider(const std::vector<Guid>& providers, const ServiceDescription& provider) {
  return std::find(providers.begin(), providers.end(), Guid{provider.provider}) != providers.end();
}

// Power of two choices (R22): all clients that look for the least loaded provider at once would
// find the same one.
void put_less_loaded_first(Table::Found& providers, std::size_t equals,
                           const brokerless_discovery::LoadBoard& loads) {
  const auto load = [&](std::size_t index) { return loads.load_of({providers[index]->provider}); };
  if (equals < 2) return;
  thread_local std::minstd_rand random{std::random_device{}()};
  std::size_t one = std::uniform_int_distribution<std::size_t>(0, equals - 1)(random);
  std::size_t other = std::uniform_int_distribution<std::size_t>(0, equals - 2)(random);
  if (other >= one) ++other;
  if (one > other) std::swap(one, other);
  bool level = true;
  for (std::size_t i = 1; i < equals; ++i) level = level && load(i) == load(0);
  if (level) return;
  const auto chosen =
      providers.begin() + static_cast<std::ptrdiff_t>(load(other) < load(one) ? other : one);
  std::rotate(providers.begin(), chosen, chosen + 1);
}

// Those that lack operations stand behind those that lack none, and before those that are to be
// asked last.
void arrange(Table::Found& providers, const ProviderQuery& wanted, const Query& query,
             const brokerless_discovery::LoadBoard& loads) {
  std::erase_if(providers, [&](const auto& provider) {
    return contains_provider(wanted.excluded, *provider);
  });
  auto last = std::stable_partition(providers.begin(), providers.end(), [&](const auto& provider) {
    return !contains_provider(wanted.last, *provider);
  });
  const auto complete = std::stable_partition(providers.begin(), last, [&](const auto& provider) {
    return brokerless_discovery::has_all_operations(*query.client, *provider);
  });
  if (complete != providers.begin()) last = complete;
  const auto preferred = [&](const auto& provider) {
    return provider->host == query.preferred_host;
  };
  auto equals = std::find_if_not(providers.begin(), last, preferred);
  if (equals == providers.begin()) equals = last;
  put_less_loaded_first(providers, static_cast<std::size_t>(equals - providers.begin()), loads);
}

// Empty where it may be.
std::string why_not_shared_memory(const Connector::Parts& parts,
                                  const ServiceDescription& provider) {
  if (provider.host != brokerless_discovery::ProcessWatch::host()) {
    return "the provider is on another host";
  }
  if (!parts.same_host) return "the caller does not use shared memory for calls";
  if (!brokerless_discovery::offers_shared_memory_calls(provider)) {
    return "the provider does not use shared memory for calls";
  }
  return {};
}

// Through shared memory where both sides have it; otherwise, and where the provider is not reached
// in that way, over DDS. Who has answered there is not asked again.
std::shared_ptr<rpc::RemoteChannel> open_remote(const Connector::Parts& parts,
                                                const ServiceDescription& provider,
                                                rpc::RemoteChannel::Options options) {
  const calls::Address address{provider.service, Guid{provider.provider},
                               representation_of(provider)};
  const auto open = [&](calls::ClientPort& port, rpc::RemoteChannel::Options how) {
    return rpc::RemoteChannel::open(port, parts.control, parts.continuations, parts.clock, address,
                                    std::move(how));
  };
  options.not_faster = why_not_shared_memory(parts, provider);
  if (options.not_faster.empty()) {
    const Instant begin = parts.clock->now();
    auto shared = options;
    shared.transport = "shared memory";
    shared.lends = brokerless_discovery::takes_loans(provider);
    shared.gone = "its process ended, or it closed the connection";
    const auto reached = std::make_shared<bool>(false);
    shared.begun = [reached, begun = options.begun](const auto& channel) {
      *reached = true;
      begun(channel);
    };
    try {
      return open(*parts.same_host, std::move(shared));
    } catch (const Unavailable& why) {
      if (*reached) throw;
      log(LogLevel::Debug, "connector", options.peer + " is called over DDS: " + why.what());
      options.not_faster = why.what();
    }
    options.timeout -= std::min(options.timeout, parts.clock->now() - begin);
  }
  return open(parts.dds, std::move(options));
}

ProviderConnection await_connection(const brokerless_discovery::Broker& broker, const Query& query,
                                    Instant deadline, const FailoverChannel::Connect& connect) {
  for (;;) {
    broker.await_service(query, deadline);
    try {
      return connect({deadline});
    } catch (const NoProvider&) {  // it has just gone
    }
  }
}

}  // namespace

Connector::Connector(const Parts& parts)
    : parts_(std::make_shared<const Parts>(parts)), connections_(std::make_shared<Connections>()) {}

void Connector::close() {
  connections_->close();
  parts_->broker.end_waits();
  connections_->await_openings();
}

std::vector<ConnectionInfo> Connector::connections() const { return connections_->infos(); }

std::shared_ptr<Channel> Connector::open_provider(const ServiceDescription& provider,
                                                  const std::string& strategy,
                                                  Duration timeout) const {
  return open_connection(provider, strategy, timeout).channel;
}

ProviderConnection Connector::open_connection(const ServiceDescription& provider,
                                              const std::string& strategy, Duration timeout) const {
  const Connections::Opening opening(*connections_);
  const Guid id{provider.provider};
  if (const auto service = parts_->directory->find(id)) {
    ProviderConnection connection{
        id, rpc::LocalChannel::open(service, parts_->clock, parts_->continuations, strategy,
                                    parts_->journal)};
    connections_->add(connection.channel);
    return connection;
  }
  rpc::RemoteChannel::Options options;
  options.strategy = strategy;
  options.peer = peer_name(provider);
  options.timeout = timeout;
  options.spin = parts_->spin;
  options.journal = parts_->journal;
  options.stands = [&broker = parts_->broker, connections = connections_, id] {
    connections->refuse_if_closed();
    return broker.knows(id);
  };
  options.begun = [connections = connections_](const auto& channel) { connections->add(channel); };
  const auto participant = parts_->broker.participant_of(id);
  if (!participant) throw Unavailable(options.peer + " left before it was connected");
  options.participant = *participant;
  auto channel = open_remote(*parts_, provider, std::move(options));
  ProviderConnection connection{id, channel};
  follow(parts_->broker, channel, connection);
  return connection;
}

Query Connector::query(const InterfaceInfo& interface, const ConnectOptions& options) const {
  Query query =
      parts_->broker.query(options.name.empty() ? std::string(interface.name) : options.name);
  query.client = &interface;
  query.provider = options.provider;
  query.constraints = options.constraints;
  query.preferred_host = options.preferred_host == ConnectOptions::kOwnHost
                             ? brokerless_discovery::ProcessWatch::host()
                             : options.preferred_host;
  if (options.system) {
    query.system = *options.system == ConnectOptions::kAnySystem ? std::nullopt : options.system;
  }
  return query;
}

std::shared_ptr<Channel> Connector::open(const InterfaceInfo& interface,
                                         const ConnectOptions& options) {
  const Instant deadline = deadline_of(options, *parts_->clock);
  if (options.foreign) return open_foreign(interface, options);
  tell_useless_hedging(interface, options);
  const Connections::Opening opening(*connections_);
  const Query query = this->query(interface, options);
  const auto connect = [connector = *this, query,
                        strategy = options.strategy](const ProviderQuery& wanted) {
    return connector.open_next(query, strategy, wanted);
  };
  const auto channel = std::make_shared<FailoverChannel>(
      await_connection(parts_->broker, query, deadline, connect), connect, options.hedge_after);
  connections_->add(channel);
  channel->changes().follow(std::make_shared<brokerless_discovery::Broker::Registration>(
      parts_->broker.observe([weak = std::weak_ptr(channel)](const Change&) {
        if (const auto follows = weak.lock()) follows->changes().on_change();
      })));
  return channel;
}

std::vector<Connector::Opened> Connector::open_all(const InterfaceInfo& interface,
                                                   const ConnectOptions& options) const {
  const Connections::Opening opening(*connections_);
  const Instant deadline = deadline_of(options, *parts_->clock);
  std::vector<Opened> all;
  std::exception_ptr failure;
  for (const auto& provider : parts_->broker.await_service(query(interface, options), deadline)) {
    const Duration left = std::max(Duration::zero(), deadline - parts_->clock->now());
    try {
      all.push_back(
          {Guid{provider->provider}, provider->entity,
           open_provider(*provider, options.strategy, std::min<Duration>(left, kOpenPatience))});
    } catch (const Error& error) {
      if (!is_refusal(error.code())) throw;
      failure = std::current_exception();
    }
  }
  if (all.empty()) std::rethrow_exception(failure);
  return all;
}

ConnectOptions Connector::to(const ServiceReference& reference, ConnectOptions options) {
  if (reference.is_nil()) {
    throw InvalidArgument("the reference to " + reference.interface_name +
                          " is nil: it names no provider");
  }
  options.name = reference.interface_name;
  options.provider = reference.provider;
  options.system = std::string(ConnectOptions::kAnySystem);
  return options;
}

std::shared_ptr<Channel> Connector::open_foreign(const InterfaceInfo& interface,
                                                 const ConnectOptions& options) const {
  const Connections::Opening opening(*connections_);
  rpc::RemoteChannel::Options dds_options;
  const std::string service = options.name.empty() ? std::string(interface.name) : options.name;
  dds_options.peer = "the foreign server of " + service;
  dds_options.not_faster = "the provider is not built with Skein";
  dds_options.timeout = options.timeout;
  dds_options.spin = parts_->spin;
  dds_options.journal = parts_->journal;
  dds_options.stands = [connections = connections_] {
    connections->refuse_if_closed();
    return true;
  };
  dds_options.begun = [connections = connections_](const auto& channel) {
    connections->add(channel);
  };
  return rpc::RemoteChannel::open(parts_->dds, parts_->control, parts_->continuations,
                                  parts_->clock, {service, Guid{}, interface.representation()},
                                  std::move(dds_options));
}

// The first provider that takes the session: in the Broker's order, those to be asked last at the
// end. Where none answers, all together are given as much time again, so that one that is slow is
// reached, and one that is not known yet does not wait for one that never answers. Where one has no
// room, and no other takes it, the caller is to back off: it is not asked again and again.
ProviderConnection Connector::open_next(const Query& query, const std::string& strategy,
                                        const ProviderQuery& wanted) const {
  const Connections::Opening opening(*connections_);
  const auto left = [&] {
    return std::max(Duration::zero(), wanted.deadline - parts_->clock->now());
  };
  std::exception_ptr failure;
  bool overloaded = false;
  std::optional<Instant> first_asked;
  do {
    if (failure) {
      connections_->pause(*parts_->clock,
                          std::min(wanted.deadline, parts_->clock->after(kRetryPause)));
    }
    auto providers = parts_->broker.find_service(query);
    if (providers.empty()) throw NoProvider(parts_->broker.explain(query));
    arrange(providers, wanted, query, parts_->loads);
    if (providers.empty()) throw NoProvider("no other provider of " + query.name + " is available");
    // Who is asked for by its identity has all of the time.
    const bool may_try_another = query.provider.is_nil() && (wanted.wait || providers.size() > 1);
    const Instant now = parts_->clock->now();
    const Duration spent = now - first_asked.value_or(now);
    first_asked = first_asked.value_or(now);
    for (const auto& provider : providers) {
      try {
        const auto patience =
            std::max<Duration>(kOpenPatience, spent / static_cast<Duration::rep>(providers.size()));
        return open_connection(*provider, strategy,
                               may_try_another ? std::min(left(), patience) : left());
      } catch (const Error& error) {
        if (!is_refusal(error.code())) throw;
        const bool full = error.code() == ErrorCode::Overloaded;
        if (full || !overloaded) failure = std::current_exception();
        overloaded |= full;
      }
    }
  } while (wanted.wait && !overloaded && left() > Duration::zero() && !connections_->closed());
  std::rethrow_exception(failure);
}

}  // namespace skein
