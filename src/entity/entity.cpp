#include "skein/entity.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "brokerless_discovery/broker.hpp"
#include "brokerless_discovery/load_board.hpp"
#include "brokerless_discovery/process_watch.hpp"
#include "call_port/dds_call_port.hpp"
#include "connector/connector_parts.hpp"
#include "core/log.hpp"
#include "core/suggestion.hpp"
#include "core/system/interface_name.hpp"
#include "core/threads/leave_behind.hpp"
#include "dds/port/options_check.hpp"
#include "dds/port/port.hpp"
#include "dds/port/vendor_names.hpp"
#include "entity/asker.hpp"
#include "entity/entity_access.hpp"
#include "entity/head/head_parts.hpp"
#include "entity/inspection_topic.hpp"
#include "entity/namesakes.hpp"
#include "entity/periodic_topic.hpp"
#include "entity/self_report.hpp"
#include "idl/types/dynamic_support.hpp"
#include "rpc/server/remote_server.hpp"
#include "rpc/service/call_journal.hpp"
#include "rpc/service/local_directory.hpp"
#include "rpc/service/reception.hpp"
#include "rpc/service/service.hpp"
#include "same_host/call_ports.hpp"
#include "skein/describe.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"
#include "skein/introspection.idl.hpp"
#include "topics/register.hpp"

namespace skein {
namespace {

using brokerless_discovery::Broker;
using brokerless_discovery::ServiceDescription;

// A CSP that does not return within this time of the entity's end is left behind.
constexpr std::chrono::milliseconds kStopPatience{2000};

// In less the endpoints for a question are hardly made and matched.
constexpr std::chrono::milliseconds kLeastToAsk{100};

// A provider in another language decodes by its description of the types, and so gets all in the
// message.
bool reads_in_place(const InterfaceInfo& interface) {
  return std::ranges::none_of(interface.operations, [](const OperationInfo& operation) {
    return idl::DynamicSupport::of(*operation.in) != nullptr;
  });
}

ServiceDescription describe(const InterfaceInfo& interface, const Guid& provider,
                            const ServiceOptions& options) {
  ServiceDescription description;
  description.provider = provider.bytes;
  description.service = interface.name;
  for (const InterfaceInfo* base : interface.bases) description.bases.emplace_back(base->name);
  for (const OperationInfo& operation : interface.operations) {
    description.operations.push_back(
        {std::string(operation.name), operation.hash, operation.signature});
  }
  description.xcdr2 = is_xcdr2(interface.representation());
  for (const GrowingMember& member : interface.growing) {
    description.growing.push_back({member.type, member.member, member.digest, member.required});
  }
  for (const ServiceAttribute& attribute : options.attributes) {
    description.attributes.push_back({attribute.name, attribute.value});
  }
  description.subcomponents = options.subcomponents;
  description.component = options.component;
  return description;
}

void check_servant(const std::shared_ptr<Servant>& servant, const std::string& who) {
  if (!servant) throw InvalidArgument("the service of '" + who + "' has no implementation: null");
}

void check_owner(const std::string& owner, const std::string& csp) {
  const auto slash = owner.find('/');
  if (slash != std::string::npos && slash > 0 && slash + 1 < owner.size()) return;
  throw InvalidArgument("the owner '" + owner + "' of the CSP '" + csp +
                        "' is no entity: write SYSTEM/ENTITY, as Entity::id() returns it");
}

// One letter is a slip; what differs by more may be an attribute of the user's own.
void tell_misspelt(const std::string& entity, const std::string& name, const std::string& who) {
  static const std::array<std::string, 2> read{"latency", "quality"};
  const std::string meant = suggestion(name, read, 1);
  if (meant.empty()) return;
  log(LogLevel::Warning, entity,
      "'" + who + "' declares the attribute '" + name + "', which no Head reads" + meant);
}

// A Head reads these two, whether or not a dictionary describes them.
void check_attributes(const ServiceOptions& options, const std::string& entity,
                      const std::string& who) {
  using Kind = brokerless_discovery::Quantity::Kind;
  for (const auto& [name, value] : options.attributes) {
    const auto quantity = brokerless_discovery::quantity_of(value);
    const bool latency = name == "latency";
    if (!latency && name != "quality") {
      tell_misspelt(entity, name, who);
      continue;
    }
    const bool sound = std::isfinite(quantity.value) && (!latency || quantity.value >= 0);
    if (!sound || (quantity.kind != Kind::Number && !(latency && quantity.kind == Kind::Time))) {
      throw InvalidArgument("the attribute " + name + " of '" + who + "' is '" + value +
                            "'; write a number" +
                            (latency ? " of milliseconds from 0 on, or a duration: 0.3 s" : ""));
    }
    if (!latency && (quantity.value < 0 || quantity.value > 1)) {
      log(LogLevel::Warning, entity,
          "'" + who + "' declares a quality of " + value +
              "; the scale is 0 to 1 for all CSPs of a mission, or they cannot be compared");
    }
  }
}

// A service of its own strand is known by its provider; empty where this entity does not know it.
std::string name_of(const Broker& broker, const Guid& provider) {
  for (const auto& description : broker.all()) {
    if (description->provider != provider.bytes) continue;
    return scoped_interface_name(description->service) + " of " + description->entity + " (" +
           description->system + ")";
  }
  return {};
}

}  // namespace

// In the order in which it comes to be; it goes in the opposite one.
struct Entity::Provided {
  std::string name;
  std::shared_ptr<ThreadExecutor> executor;
  std::shared_ptr<rpc::Service> service;  // keeps the executor, and the clock
  std::unique_ptr<rpc::RemoteServer> server;
  std::unique_ptr<rpc::RemoteServer> same_host_server;
  Broker::Registration load;
  Broker::Registration registration;
  std::string owner;  // empty for a Body
  bool awaited = false;

  ~Provided() {
    close();
    await_end(std::chrono::steady_clock::now() + kStopPatience);
  }

  /// No more calls come, and those that run are told to stop. Twice is no error.
  void close() {
    registration.withdraw();
    load.withdraw();
    same_host_server.reset();
    server.reset();
    if (service) service->close();
    executor->request_stop();
  }

  /// Clients have been told; false where some have calls, or have not left, at the deadline.
  bool finish(Instant deadline) {
    const bool gone = !server || server->await_clients_gone(deadline);
    const bool gone_here = !same_host_server || same_host_server->await_clients_gone(deadline);
    return service->finish(deadline) && gone && gone_here;
  }

  /// Requests that wait or run.
  std::size_t active() const {
    return server->counters().active + (same_host_server ? same_host_server->counters().active : 0);
  }

  /// Once closed; false where a call did not return in time. The second time it does not wait.
  bool await_end(std::chrono::steady_clock::time_point deadline) {
    if (std::exchange(awaited, true)) return true;
    const bool ended = !service || service->await_end(deadline);
    const auto patience = std::chrono::ceil<std::chrono::milliseconds>(
        std::max<Duration>(deadline - std::chrono::steady_clock::now(), Duration::zero()));
    if (executor->stop_or_abandon(patience, service) && ended) return true;
    log(LogLevel::Error, name, "a call did not return; its thread is left behind");
    return false;
  }
};

struct Entity::State {
  explicit State(EntityOptions given)
      : options(std::move(given)),
        process(options.process ? options.process : std::make_shared<Process>()),
        participant(make_participant()),
        calls_over_dds(*participant),
        same_host(options.shared_memory_calls.value_or(!options.vendor->is_inside_process())
                      ? std::make_unique<same_host::CallPorts>(
                            same_host::PortOptions{participant->guid(), options.spin})
                      : nullptr),
        journal(std::make_shared<rpc::CallJournal>(*participant, process->clock(), control,
                                                   options.system + "/" + options.name)),
        recorder(std::make_shared<rpc::CallRecorder>(*participant, process->clock(), control,
                                                     options.system + "/" + options.name)),
        broker(*participant, process->clock(), control, process->watch(),
               {options.system, options.name, options.vendor->name(), options.lease, place(),
                [this](const ServiceDescription& provider, const Guid& who, Instant deadline,
                       const std::function<bool()>& gives_up) {
                  return types_told_by(provider, who, deadline, gives_up);
                }}),
        loads(*participant, process->clock(), control),
        connector({calls_over_dds, same_host ? &same_host->clients : nullptr, broker, loads,
                   process->directory(), control, continuations, process->shared_clock(),
                   options.spin, journal}),
        head({connector, broker, process->directory(), process->clock(), *participant, control,
              options.system + "/" + options.name},
             options.head) {}

  std::unique_ptr<dds::Participant> make_participant() const {
    is_logged(LogLevel::Error);  // tells of a SKEIN_LOG that is no level
    if (!options.vendor) {
      throw InvalidArgument("entity '" + options.name +
                            "' has no vendor; pass dds::load_vendor(\"" +
                            dds::vendor_names().front() + "\") or another");
    }
    return options.vendor->create_participant(participant_options());
  }

  dds::ParticipantOptions participant_options() const {
    dds::ParticipantOptions participant_options;
    participant_options.domain = options.domain;
    participant_options.name = options.system + "/" + options.name;
    participant_options.network = options.network;
    participant_options.lease = options.lease;
    return participant_options;
  }

  TopicQos qos_of(const std::string& topic, TopicQos qos) const {
    if (qos.systems.empty()) qos.systems = {options.system};
    if (options.adjust_topic) options.adjust_topic(topic, qos);
    return qos;
  }

  Executor& topic_executor() {
    std::lock_guard lock(mutex);
    if (!topics) {
      topics = std::make_unique<ThreadExecutor>("skein-topics", ThreadExecutor::Tasks::Short);
    }
    return *topics;
  }

  std::string place() const {
    if (options.vendor->name() != dds::kLoopback) return dds::place_of(participant_options());
    return "domain " + std::to_string(options.domain) + " of the loopback network";
  }

  const EntityOptions options;
  const std::shared_ptr<Process> process;
  topics::Register topic_register;
  std::unique_ptr<dds::Participant> participant;
  calls::DdsCallPort calls_over_dds;
  const std::unique_ptr<same_host::CallPorts> same_host;
  // Shared with connections, which may outlive the entity.
  const std::shared_ptr<ThreadExecutor> continuations =
      std::make_shared<ThreadExecutor>("skein-continue", ThreadExecutor::Tasks::Short);
  ThreadExecutor control{"skein-control", ThreadExecutor::Tasks::Short};
  std::shared_ptr<rpc::CallJournal> journal;
  std::shared_ptr<rpc::CallRecorder> recorder;
  Broker broker;
  brokerless_discovery::LoadBoard loads;
  Connector connector;
  Head head;
  mutable std::mutex mutex;
  std::unique_ptr<ThreadExecutor> topics;  // once there is a subscription
  std::map<Guid, std::unique_ptr<Provided>> provided;
  std::vector<std::shared_ptr<rpc::Service>> hung;  // Bodies that were withdrawn meanwhile
  entity::Namesakes namesakes{options.system, options.name,
                              brokerless_discovery::ProcessWatch::host(),
                              static_cast<std::uint32_t>(::getpid())};
  // These go first: they ask all that stands above.
  Broker::Registration namesake_watch;
  std::vector<std::shared_ptr<void>> periodic_topics;
  std::optional<introspection::Answerer> answerer;

  /// What makes no progress, in words; empty where everything does.
  std::string stuck() const {
    if (head.degraded()) return "several CSPs do not return from calls whose time is over";
    std::lock_guard lock(mutex);
    for (const auto& [id, service] : provided) {
      // An entity's own CSPs are its Head's to judge.
      if (service->server && service->service->is_stuck())
        return "the calls of '" + service->name + "' do not return, and their deadlines are over";
    }
    return {};
  }

  /// Waits for the calls of a service that has been closed.
  void note_hung(Provided& closed, std::chrono::steady_clock::time_point deadline) {
    if (closed.await_end(deadline) || !closed.owner.empty()) return;
    std::lock_guard lock(mutex);
    hung.push_back(closed.service);
  }

  std::vector<introspection::ServiceStatistics> statistics() const {
    std::vector<introspection::ServiceStatistics> all;
    std::lock_guard lock(mutex);
    for (const auto& [id, service] : provided) {
      auto& statistics = all.emplace_back(service->service->statistics());
      statistics.entity = service->name;
      statistics.system = options.system;
    }
    return all;
  }

  bool answer(const inspection::Question& question, inspection::Answer& answer) {
    switch (question.subject) {
      case inspection::Subject::Self:
        answer.peer.push_back(peer());
        return true;
      case inspection::Subject::Topics:
        for (const topics::Endpoint& endpoint : topic_register.endpoints()) {
          answer.topics.push_back(introspection::report_of(endpoint));
        }
        return true;
      case inspection::Subject::Connections:
        for (const ConnectionInfo& connection : connector.connections()) {
          answer.connections.push_back(introspection::report_of(connection));
        }
        return true;
      case inspection::Subject::Types:
        break;
    }
    if (auto types = types_of(question.name)) answer.types.push_back(std::move(*types));
    return !answer.types.empty();
  }

  inspection::Peer peer() {
    inspection::Peer peer = introspection::report_of_this_process();
    peer.vendor = options.vendor->name();
    peer.degraded = head.degraded();
    std::lock_guard lock(mutex);
    peer.services = static_cast<std::uint32_t>(provided.size());
    return peer;
  }

  /// For Broker::Options::tell_types.
  std::shared_ptr<const types::TypeSystem> types_told_by(const ServiceDescription& provider,
                                                         const Guid& who, Instant deadline,
                                                         const std::function<bool()>& gives_up) {
    if (const auto service = process->directory()->find({provider.provider}))
      return std::make_shared<types::TypeSystem>(skein::describe(service->interface_info()));
    const Duration left = deadline - process->clock().now();
    if (left < kLeastToAsk) return nullptr;
    introspection::Asker asker(*participant, process->clock(), gives_up);
    auto told = asker.types(provider.service, who, left);
    return told ? std::make_shared<types::TypeSystem>(std::move(*told)) : nullptr;
  }

  std::optional<types::TypeSystem> types_of(const std::string& name) {
    {
      std::lock_guard lock(mutex);
      for (const auto& [id, service] : provided) {
        const InterfaceInfo& interface = service->service->interface_info();
        if (interface.name == name) return skein::describe(interface);
      }
    }
    for (const topics::Endpoint& endpoint : topic_register.endpoints()) {
      const TypeSupport& type = *endpoint.type.support;
      if (type.name == name && !type.description.declaration.empty()) return skein::describe(type);
    }
    // Where nobody has it in its code, it is known to those who publish it again.
    for (const topics::Endpoint& endpoint : topic_register.endpoints()) {
      if (endpoint.publishes && endpoint.type.described != nullptr &&
          endpoint.type.support->name == name) {
        return *endpoint.type.described;
      }
    }
    return std::nullopt;
  }
};

Entity::Entity(EntityOptions options) : state_(std::make_unique<State>(std::move(options))) {
  State& state = *state_;
  state.namesake_watch =
      state.broker.observe([&state, id = id()](const brokerless_discovery::Change& change) {
        const std::string text = state.namesakes.look_at(change);
        if (!text.empty()) log(LogLevel::Warning, id, text);
      });
  const auto tell = [&state]<class T>(const introspection::Topic<T>& topic,
                                      typename introspection::PeriodicTopic<T>::Source source) {
    state.periodic_topics.push_back(std::make_shared<introspection::PeriodicTopic<T>>(
        *state.participant, state.process->clock(), state.control, topic, std::move(source)));
  };
  tell(introspection::kTopic<introspection::ServiceStatistics>,
       [&state](bool) { return state.statistics(); });
  tell(introspection::kTopic<introspection::LogLine>, introspection::LogReport(id()));
  state.answerer.emplace(
      *state.participant, state.control, id(),
      [&state](const inspection::Question& question, inspection::Answer& answer) {
        return state.answer(question, answer);
      });
}

Entity::~Entity() {
  state_->connector.close();
  std::map<Guid, std::unique_ptr<Provided>> provided;
  {
    std::lock_guard lock(state_->mutex);
    provided.swap(state_->provided);
  }
  for (const auto& [id, service] : provided) state_->process->directory()->remove(id);
  for (const auto& [id, service] : provided) service->close();
  const auto deadline = std::chrono::steady_clock::now() + kStopPatience;  // of all together
  for (const auto& [id, service] : provided) state_->note_hung(*service, deadline);
  provided.clear();
  const bool stuck =
      std::ranges::any_of(state_->hung, [](const auto& body) { return !body->await_end({}); });
  state_->continuations->finish();
  state_->journal->close();
  state_->recorder->close();
  // A Body may use the Head, and all that this uses, should it ever come back; a CSP knows nothing
  // of them.
  if (stuck) leave_behind(std::shared_ptr<State>(std::move(state_)));
}

const EntityOptions& Entity::options() const noexcept { return state_->options; }
std::string Entity::id() const { return state_->options.system + "/" + state_->options.name; }

Guid Entity::guid() const { return state_->participant->guid().participant(); }
Connector& Entity::connector() noexcept { return state_->connector; }
Broker& Entity::broker() noexcept { return state_->broker; }
Head& Entity::head() noexcept { return state_->head; }
Clock& Entity::clock() noexcept { return state_->process->clock(); }
dds::Participant& EntityAccess::participant(Entity& entity) noexcept {
  return *entity.state_->participant;
}

std::unique_ptr<topics::TopicWriter> Entity::topic_writer(const std::string& name,
                                                          const topics::TopicType& type,
                                                          const TopicQos& qos) {
  return std::make_unique<topics::TopicWriter>(*state_->participant, name, type,
                                               state_->qos_of(name, qos), &state_->topic_register);
}

std::unique_ptr<topics::TopicReader> Entity::topic_reader(const std::string& name,
                                                          const topics::TopicType& type,
                                                          const TopicQos& qos,
                                                          topics::TopicReader::Consumer consumer,
                                                          SubscriptionOptions options) {
  return std::make_unique<topics::TopicReader>(*state_->participant, state_->topic_executor(), name,
                                               type, state_->qos_of(name, qos), std::move(consumer),
                                               std::move(options), &state_->topic_register);
}

Guid Entity::provide(std::shared_ptr<Servant> servant, const ServiceOptions& options) {
  return add(std::move(servant), options, state_->options.name, "");
}

Guid Entity::provide_csp(const std::string& name, const std::string& owner,
                         std::shared_ptr<Servant> servant, const ServiceOptions& options) {
  check_owner(owner, name);
  return add(std::move(servant), options, name, owner);
}

Guid Entity::add(std::shared_ptr<Servant> servant, const ServiceOptions& options,
                 const std::string& name, const std::string& owner) {
  check_servant(servant, name);
  check_attributes(options, id(), name);
  if (options.threads == 0) {
    throw InvalidArgument("the service of '" + name + "' has 0 threads; give it 1 or more");
  }
  if (options.queue == 0) {
    throw InvalidArgument("the service of '" + name +
                          "' has a `queue` of 0, which refuses every call; give it 1 or more");
  }
  const InterfaceInfo& interface = servant->interface_info();
  if (!owner.empty()) refuse_second_csp(interface, name, owner);
  auto executor =
      std::make_shared<ThreadExecutor>(name, options.threads, options.queue, options.scheduling);
  auto provided = std::make_unique<Provided>();
  provided->name = name;
  provided->owner = owner;
  provided->executor = std::move(executor);
  rpc::Service::Options service_options;
  service_options.id = state_->broker.new_provider();
  service_options.keeps =
      std::make_shared<std::pair<std::shared_ptr<Clock>, std::shared_ptr<ThreadExecutor>>>(
          state_->process->shared_clock(), provided->executor);
  service_options.threads = options.threads;
  service_options.queue = options.queue;
  service_options.journal = state_->journal;
  service_options.recorder = state_->recorder;
  service_options.name_of = [&broker = state_->broker](const Guid& strand) {
    return name_of(broker, strand);
  };
  service_options.thread = options.thread;
  if (owner.empty()) {
    service_options.open = [&head = state_->head](const rpc::OpenRequest& request) {
      return head.initialize(request);
    };
  }
  provided->service = std::make_shared<rpc::Service>(std::move(servant), *provided->executor,
                                                     state_->process->clock(), service_options);
  const Guid id = provided->service->id();
  // An owner calls its own CSP in the process; nobody else may, so no endpoint is needed.
  if (owner != this->id()) {
    provided->server = std::make_unique<rpc::RemoteServer>(
        state_->calls_over_dds, state_->control, state_->process->clock(), provided->service,
        rpc::RemoteServer::Options{.foreign_clients = owner.empty(),
                                   .on_load = state_->loads.notifier()});
  }
  if (provided->server && state_->same_host) {
    try {
      provided->same_host_server = std::make_unique<rpc::RemoteServer>(
          state_->same_host->providers, state_->control, state_->process->clock(),
          provided->service,
          rpc::RemoteServer::Options{.foreign_clients = false,
                                     .on_load = state_->loads.notifier()});
      // While it takes requests it polls for as long as the entity says.
      if (options.threads == 1 && options.scheduling.spin <= state_->options.spin) {
        provided->executor->work_while_idle(std::make_shared<rpc::Reception>(
            *provided->service, provided->same_host_server->delivery()));
      }
    } catch (const Unavailable& why) {
      log(LogLevel::Warning, name, std::string("is called over DDS alone: ") + why.what());
    }
  }
  if (owner.empty()) {
    provided->load = state_->loads.tell(id, [&provided = *provided] { return provided.active(); });
  }
  state_->process->directory()->add(provided->service);
  ServiceDescription description = describe(interface, id, options);
  description.entity = name;
  description.owner = owner;
  brokerless_discovery::give_wire(description);
  if (provided->same_host_server) {
    brokerless_discovery::offer_shared_memory_calls(description, reads_in_place(interface));
  }
  provided->registration = state_->broker.add_service(std::move(description));
  std::lock_guard lock(state_->mutex);
  state_->provided.emplace(id, std::move(provided));
  return id;
}

// A Head knows a CSP again by its name: two of one name would share a history and a quarantine.
void Entity::refuse_second_csp(const InterfaceInfo& interface, const std::string& name,
                               const std::string& owner) const {
  std::lock_guard lock(state_->mutex);
  for (const auto& [id, other] : state_->provided) {
    if (other->name != name || other->owner != owner ||
        other->service->interface_info().name != interface.name)
      continue;
    throw InvalidArgument("'" + this->id() + "' already provides a CSP '" + name + "' for " +
                          scoped_interface_name(std::string(interface.name)) + " to " + owner +
                          "; give this one another name");
  }
}

std::vector<introspection::ServiceStatistics> Entity::statistics() const {
  return state_->statistics();
}

bool Entity::check_progress(std::function<void(const std::string& stuck)> report) {
  return state_->control.post(
      [&state = *state_, report = std::move(report)] { report(state.stuck()); });
}

bool Entity::drain(TimeSpan patience) {
  const Instant deadline = clock().after(patience);
  const bool bodies = drain_some(false, deadline);  // which may call the CSPs
  return drain_some(true, deadline) && bodies;
}

bool Entity::drain_some(bool managed, Instant deadline) {
  std::vector<std::unique_ptr<Provided>> leaving;
  {
    std::lock_guard lock(state_->mutex);
    for (auto each = state_->provided.begin(); each != state_->provided.end();) {
      const auto next = std::next(each);
      if (each->second->owner.empty() != managed)
        leaving.push_back(std::move(state_->provided.extract(each).mapped()));
      each = next;
    }
  }
  for (const auto& provided : leaving) {
    state_->broker.leave(provided->service->id());
    provided->service->leave();
  }
  bool finished = true;
  for (const auto& provided : leaving) finished = provided->finish(deadline) && finished;
  for (const auto& provided : leaving) {
    state_->process->directory()->remove(provided->service->id());
    provided->close();
  }
  const auto end = std::chrono::steady_clock::now() + kStopPatience;
  for (const auto& provided : leaving) state_->note_hung(*provided, end);
  return finished;
}

void Entity::withdraw(const Guid& provider) {
  std::unique_ptr<Provided> provided;
  {
    std::lock_guard lock(state_->mutex);
    if (auto node = state_->provided.extract(provider)) provided = std::move(node.mapped());
  }
  if (!provided) return;
  state_->process->directory()->remove(provider);
  provided->close();
  state_->note_hung(*provided, std::chrono::steady_clock::now() + kStopPatience);
}

}  // namespace skein
