#include "mission/peer/peer.hpp"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <semaphore>
#include <stop_token>
#include <thread>

#include "component_code.hpp"
#include "core/log.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "core/system/ending_signals.hpp"
#include "core/system/interface_name.hpp"
#include "core/threads/run_user_code.hpp"
#include "core/threads/thread_settings.hpp"
#include "entity/asked_parameters.hpp"
#include "hung_csp.hpp"
#include "live_parameters.hpp"
#include "mission/component/component_xml.hpp"
#include "mission/process/address_space.hpp"
#include "mission/process/crash_report.hpp"
#include "mission/process/exit_codes.hpp"
#include "mission/process/progress_report.hpp"
#include "mission/process/ready.hpp"
#include "mission/process/wake_up.hpp"
#include "mission/supervise/child_state.hpp"
#include "mission/supervise/launch_plan.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"
#include "used_topics.hpp"

namespace skein::launch {
namespace {

using profile::CspProfile;
using profile::MissionProfile;
using profile::PeerProfile;

constexpr std::size_t kLongestError = 4096;

/// In this thread, and in those that it starts from now on.
void block_ending_signals() {
  const sigset_t signals = ending_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

[[noreturn]] void refuse_process(const MissionProfile& mission, const std::string& process) {
  std::vector<std::string> names;
  for (const PeerProfile& peer : mission.peers) {
    names.push_back(peer.name);
    for (const CspProfile& csp : peer.csps) {
      if (csp.process == profile::CspProcess::Own) names.push_back(peer.name + "/" + csp.name);
    }
  }
  throw InvalidArgument("mission '" + mission.name + "' has no process '" + process + "'" +
                        suggestion(process, names) + "; it has " + list_of(names));
}

// `owner` is a peer or one of its CSPs.
template <class Profile>
EntityOptions options_of(const MissionProfile& mission, const PeerProfile& peer,
                         const Profile& owner) {
  EntityOptions options;
  options.name = peer.name;
  options.system = peer.system;
  options.vendor = dds::load_vendor(owner.vendor);
  options.domain = static_cast<std::uint32_t>(mission.domain);
  options.spin = owner.threads.settings.spin;
  options.network = network_of(mission, peer);
  options.network.shared_memory = owner.shared_memory;
  options.shared_memory_calls = owner.shared_memory_calls;
  if (!peer.topics.empty()) {
    options.adjust_topic = [rules = peer.topics](const std::string& topic, TopicQos& qos) {
      if (const auto* found = profile::find_topic(rules, topic)) found->change(qos);
    };
  }
  return options;
}

/// Of the components of one process. They are offered once one may change.
std::shared_ptr<LiveParameters> parameters_of(Entity& entity, const profile::Dictionary& dictionary,
                                              const ComponentRegistry& registry) {
  return std::make_shared<LiveParameters>(
      dictionary,
      [&registry](const std::string& name, const ParameterValue& value) {
        registry.check_value(name, value);
      },
      [&entity](std::shared_ptr<ILiveParameters> service) {
        entity.provide<ILiveParameters>(std::move(service));
      });
}

// What the component's description declares of the interface that `servant` implements.
ServiceOptions service_options(const profile::ComponentDescription& component,
                               const profile::Dictionary& dictionary, const Servant& servant) {
  const InterfaceInfo& code = servant.interface_info();
  const auto differing = compare(component, code);
  if (!differing.empty()) throw profile::DescriptionError(differing);
  const auto* implemented = component.find_interface(code.name);
  ServiceOptions options;
  for (const auto& attribute : implemented->attributes) {
    const auto* entry = dictionary.find(profile::EntryKind::Attribute, attribute.name);
    options.attributes.push_back(
        {attribute.name, entry ? profile::plain_text(*entry, attribute.value) : attribute.value});
  }
  for (const auto& part : component.subcomponents) options.subcomponents.push_back(part.type);
  options.component = profile::write_component(component);
  return options;
}

using MadeActivity = std::function<int(const std::stop_token& told_to_end)>;

/// The name of what a factory owes and has not made; null if it has.
const char* missing_part(const std::shared_ptr<Servant>& csp) { return csp ? nullptr : "servant"; }
const char* missing_part(const ComponentRegistry::Body& body) { return missing_part(body.servant); }
const char* missing_part(const MadeActivity& made) { return made ? nullptr : "activity"; }

/// Throws InvalidArgument where no code would run for a peer or a CSP.
template <class Profile>
void demand_code(const Profile& profile, const LoadedPlugins& plugins) {
  const auto lack = find_lack(profile, plugins);
  if (!lack) return;
  throw InvalidArgument(profile::to_text(profile.where) + ": " + lack->problem + "; " +
                        lack->remedy);
}

/// While it lives, does something once the process is told to end, in a thread of its own. Does not
/// take the signal.
class EndWatch {
 public:
  /// `told` gets a descriptor that becomes readable when this object goes.
  explicit EndWatch(std::function<void(int over)> told)
      : told_(std::move(told)), thread_([this] { watch(); }) {}
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;
  ~EndWatch() {
    over_.raise();
    thread_.join();
  }

 private:
  void watch() {
    std::array<pollfd, 2> watched{
        {{signals_.descriptor(), POLLIN, 0}, {over_.descriptor(), POLLIN, 0}}};
    while (::poll(watched.data(), watched.size(), -1) < 0) {
    }
    if (watched[0].revents != 0) told_(over_.descriptor());
  }

  const std::function<void(int)> told_;
  StopRequest over_;
  SignalReader signals_;
  std::thread thread_;
};

/// Waits in a watch's thread; false where its object goes before `limit`.
bool lasts(int over, Duration limit) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(limit);
  pollfd watched{over, POLLIN, 0};
  return ::poll(&watched, 1, static_cast<int>(left.count())) == 0;
}

/// Ends the process when it is told to while a component's code runs that cannot be told, unless
/// that returns soon: before the launcher sends SIGTERM after SIGINT.
class MakingWatch {
 public:
  template <class Profile>
  explicit MakingWatch(const Profile& profile)
      : watch_([name = profile.component->name,
                limit = time_to_terminate(profile.rules.stop_timeout) / 2](int over) {
          if (!lasts(over, limit)) return;
          log(LogLevel::Warning, "launch",
              "told to end while '" + name + "' is made or tests itself, which does not return");
          const sigset_t signals = ending_signals();
          pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);  // which ends the process
        }) {}

 private:
  EndWatch watch_;
};

/// What the factory of a peer's or a CSP's component makes. Throws InvalidArgument where that is
/// nothing, and what the factory throws, with the place in the profile and the component's name.
template <class Profile, class Factory, class... Arguments>
auto make_component(const Profile& profile, const Factory& factory, Arguments&&... arguments) {
  const std::string place = profile::to_text(profile.where) + ": ";
  const std::string& name = profile.component->name;
  const MakingWatch watch(profile);
  const StartStep step("makes '" + name + "'");
  auto made = run_user_code(place + "while making '" + name + "': ",
                            [&] { return factory(std::forward<Arguments>(arguments)...); });
  const char* const missing = missing_part(made);
  if (!missing) return made;
  throw InvalidArgument(place + "the factory of '" + name + "' returned no " + missing +
                        "; return one, or throw what keeps it from that");
}

/// Throws DescriptionError where a check of a plugin refuses a value.
template <class Profile>
void demand_values(const MissionProfile& mission, const Profile& profile,
                   const LoadedPlugins& plugins) {
  const auto wrong = find_wrong_values(profile.parameters, mission.dictionary, plugins.registry());
  if (!wrong.empty()) throw profile::DescriptionError(wrong);
}

void provide_csp(Entity& entity, const std::string& owner, const MissionProfile& mission,
                 const CspProfile& csp, const LoadedPlugins& plugins,
                 const ParameterValues& values) {
  demand_code(csp, plugins);
  auto servant = make_component(csp, *plugins.registry().find_csp(csp.component->name), values);
  ServiceOptions options = service_options(*csp.component, mission.dictionary, *servant);
  options.thread = csp.threads.thread;
  options.scheduling = csp.threads.settings;
  entity.provide_csp(csp.name, owner, std::move(servant), options);
}

// The implementation knows how many threads it bears, the profile how many it is to have.
std::size_t threads_of(const PeerProfile& peer, const ComponentRegistry::Body& body) {
  if (peer.threads.thread == CallThread::Caller && body.threads > 1) {
    throw InvalidArgument(profile::to_text(peer.where) + ": thread=\"caller\" for '" + peer.name +
                          "', whose calls then run one at a time, but the implementation of '" +
                          peer.component->name + "' needs " + std::to_string(body.threads) +
                          " threads; remove thread=");
  }
  if (peer.threads.count == 0) return body.threads;
  if (peer.threads.count <= 1 || body.threads > 1) return peer.threads.count;
  throw InvalidArgument(profile::to_text(peer.where) + ": " + std::to_string(peer.threads.count) +
                        " threads for '" + peer.name + "', but the implementation of '" +
                        peer.component->name +
                        "' is made for one; remove threads=, or register a Body with more");
}

using SelfTest = std::function<void()>;

SelfTest provide_body(Entity& entity, const MissionProfile& mission, const PeerProfile& peer,
                      const ComponentRegistry& registry, const ParameterValues& values) {
  auto body = make_component(peer, *registry.find_body(peer.component->name), entity, values);
  ServiceOptions options = service_options(*peer.component, mission.dictionary, *body.servant);
  options.thread = peer.threads.thread;
  options.threads = threads_of(peer, body);
  options.scheduling = peer.threads.settings;
  entity.provide(std::move(body.servant), options);
  return body.self_test;
}

void pass(const SelfTest& self_test, const PeerProfile& peer) {
  if (!self_test) return;
  report_waiting("tests itself");
  const MakingWatch watch(peer);
  try {
    run_user_code("", self_test);
  } catch (const std::exception& error) {
    throw Unavailable("the self-test of '" + peer.name + "' has failed: " + error.what());
  }
}

bool told_to_end() {
  sigset_t pending;
  sigpending(&pending);
  return sigismember(&pending, SIGTERM) || sigismember(&pending, SIGINT) ||
         sigismember(&pending, SIGHUP);
}

/// Waits for what the peer depends on, by four fifths of its ready timeout from `begun` on, and
/// says for what. False where the process was told to end meanwhile.
bool await_dependencies(Entity& entity, const PeerProfile& peer,
                        std::chrono::steady_clock::time_point begun) {
  constexpr Duration kPatience = std::chrono::milliseconds(200);  // between looks at signals
  constexpr Duration kSilence = std::chrono::seconds(1);
  const Duration limit = peer.rules.ready_timeout * 4 / 5;
  const Instant deadline =
      entity.clock().now() + limit - Duration(std::chrono::steady_clock::now() - begun);
  std::string told;
  for (const auto& dependency : peer.component->dependencies) {
    auto query = entity.broker().query(dependency.type);
    query.system = std::nullopt;
    const Instant first_word = entity.clock().now() + kSilence;
    while (!told_to_end()) {
      const Instant look_again = std::min(deadline, entity.clock().now() + kPatience);
      try {
        entity.broker().await_service(query, look_again);
        break;
      } catch (const Unavailable& error) {
        const std::string reason = std::string("waits for its dependency: ") + error.what();
        if (reason != told && entity.clock().now() >= first_word) {
          report_waiting(reason);
          log(LogLevel::Warning, entity.id(), reason);
          told = reason;
        }
        if (look_again == deadline) {
          throw Unavailable(entity.id() +
                            " has waited in vain for its dependency: " + error.what());
        }
      }
    }
  }
  return !told_to_end();
}

/// What the Head writes at its end, and has then for sure: a process that does not end in time is
/// killed.
void save_history(Entity& entity) {
  const auto& file = entity.options().head.history;
  if (file.empty()) return;
  try {
    entity.head().history().save(file);
  } catch (const Error& error) {
    log(LogLevel::Error, entity.id(), error.what());
  }
}

/// Of its stop_timeout, for what it has accepted or begun. The rest is for the entity's own end.
Duration time_to_finish(const profile::ProcessRules& rules) { return rules.stop_timeout / 3; }

/// Runs `tell` when the process is told to end, and ends the entity's own calls soon after: one may
/// take longer than the process has.
EndWatch watch_end(Entity& entity, const profile::ProcessRules& rules, std::function<void()> tell) {
  return EndWatch([&entity, limit = time_to_finish(rules), tell = std::move(tell)](int over) {
    tell();
    save_history(entity);
    if (lasts(over, limit)) entity.connector().close();
  });
}

/// Until the process is told to end, and its calls have ended.
void serve(Entity& entity, const profile::ProcessRules& rules) {
  std::binary_semaphore told{0};
  const EndWatch watch = watch_end(entity, rules, [&] { told.release(); });
  told.acquire();
  entity.drain(time_to_finish(rules));
}

/// What a peer does that provides nothing. An activity is made now. The arguments outlive it.
std::function<int()> prepare_own_code(Entity& entity, const PeerProfile& peer,
                                      const ComponentRegistry& registry,
                                      const ParameterValues& values) {
  const std::string& name = peer.component->name;
  const auto* factory = registry.find_activity(name);
  if (!factory)
    return [&, mission = registry.find_mission(name)] { return (*mission)(entity, values); };
  return [&, activity = make_component(peer, *factory, entity, values)] {
    std::stop_source told_to_end;
    const EndWatch watch = watch_end(entity, peer.rules, [&] { told_to_end.request_stop(); });
    return activity(told_to_end.get_token());
  };
}

void load(LoadedPlugins& plugins, const std::string& plugin) {
  if (plugin.empty()) return;
  const StartStep step("loads the plugin '" + plugin + "'");
  plugins.load(plugin);
}

void tell_unread_parameters(const Entity& entity, const std::string& component,
                            const std::vector<profile::Setting>& settings) {
  for (const profile::Setting& setting : settings) {
    if (was_parameter_asked(setting.name)) continue;
    log(LogLevel::Warning, entity.id(),
        "'" + component + "' never asked for its parameter '" + setting.name + "' (" +
            profile::to_text(setting.where) + "), by get() or find()");
  }
}

int run_csp(const MissionProfile& mission, const PeerProfile& peer, const CspProfile& csp,
            ComponentRegistry& registry) {
  LoadedPlugins plugins(registry);
  load(plugins, csp.plugin);
  demand_values(mission, csp, plugins);
  EntityOptions options = options_of(mission, peer, csp);
  options.name += "." + csp.name;
  Entity entity(std::move(options));
  const auto parameters = parameters_of(entity, mission.dictionary, registry);
  provide_csp(entity, peer.system + "/" + peer.name, mission, csp, plugins,
              parameters->values_of("", csp.parameters));
  report_ready();
  const ProgressReport progress(entity, csp.rules.progress_timeout);
  serve(entity, csp.rules);
  tell_unread_parameters(entity, csp.component->name, csp.parameters);
  return 0;
}

void tell_unneeded_rules(const Entity& entity, const PeerProfile& peer, const UsedTopics& topics) {
  // The rules are those of CSPs, too.
  const bool complete = std::ranges::none_of(
      peer.csps, [](const CspProfile& csp) { return csp.process == profile::CspProcess::Own; });
  if (!complete) return;
  for (const std::string& text : topics.unneeded(peer.topics))
    log(LogLevel::Warning, entity.id(), text);
}

/// Of the peer and its CSPs in this process.
void demand_all_values(const MissionProfile& mission, const PeerProfile& peer,
                       const LoadedPlugins& plugins) {
  demand_values(mission, peer, plugins);
  for (const CspProfile& csp : peer.csps) {
    if (csp.process == profile::CspProcess::InOwner) demand_values(mission, csp, plugins);
  }
}

/// At the end: code may have asked at any time.
void tell_unused(const Entity& entity, const PeerProfile& peer, const UsedTopics& topics) {
  tell_unneeded_rules(entity, peer, topics);
  tell_unread_parameters(entity, peer.component->name, peer.parameters);
  for (const CspProfile& csp : peer.csps) {
    if (csp.process == profile::CspProcess::InOwner)
      tell_unread_parameters(entity, csp.component->name, csp.parameters);
  }
}

void tell_exception(const PeerProfile& peer, const std::exception& error) {
  const std::string text = peer.name + (peer.runs_mission ? ", which runs the mission," : "") +
                           " ended by an exception: " + error.what();
  report_waiting(text);
  std::fprintf(stderr, "skein: %s\n", printable(text, kLongestError).c_str());
}

/// The peer's plugin and those of its CSPs in this process.
LoadedPlugins load_plugins(ComponentRegistry& registry, const PeerProfile& peer) {
  LoadedPlugins plugins(registry);
  load(plugins, peer.plugin);
  for (const CspProfile& csp : peer.csps) {
    if (csp.process == profile::CspProcess::InOwner) load(plugins, csp.plugin);
  }
  std::vector<LoadedPlugins::Held> held;
  for (const std::string& text : add_versions(held, plugins.interfaces())) {
    log(LogLevel::Warning, peer.system + "/" + peer.name, text + "; build both from the same IDL");
  }
  return plugins;
}

int run_peer(const MissionProfile& mission, const PeerProfile& peer, ComponentRegistry& registry,
             std::chrono::steady_clock::time_point begun) {
  const LoadedPlugins plugins = load_plugins(registry, peer);
  demand_all_values(mission, peer, plugins);
  // An activity is told, also one that runs the mission.
  if (registry.find_activity(peer.component->name)) block_ending_signals();
  Entity* self = nullptr;
  UsedTopics topics;
  EntityOptions options = entity_options(mission, peer);
  options.adjust_topic = [&topics, adjust = options.adjust_topic](const std::string& topic,
                                                                  TopicQos& qos) {
    topics.add(topic);
    if (adjust) adjust(topic, qos);
  };
  options.head.strategies = registry.strategies();
  options.head.on_hang = [&](const Candidate& hung) { end_hung_csp(*self, peer, hung); };
  Entity entity(std::move(options));
  self = &entity;
  const auto watch_csps = entity.broker().observe(
      [&](const brokerless_discovery::Change& change) { end_stopped_csp(entity, peer, change); });
  const auto parameters = parameters_of(entity, mission.dictionary, registry);
  const ParameterValues values = parameters->values_of("", peer.parameters);
  for (const CspProfile& csp : peer.csps) {
    if (csp.process != profile::CspProcess::InOwner) continue;
    provide_csp(entity, entity.id(), mission, csp, plugins,
                parameters->values_of(csp.name + ".", csp.parameters));
  }
  demand_code(peer, plugins);
  SelfTest self_test;
  if (!peer.component->interfaces.empty())
    self_test = provide_body(entity, mission, peer, registry, values);
  if (!await_dependencies(entity, peer, begun)) return 0;
  pass(self_test, peer);
  std::function<int()> own_code;
  if (peer.component->interfaces.empty())
    own_code = prepare_own_code(entity, peer, registry, values);
  report_ready();
  const ProgressReport progress(entity, peer.rules.progress_timeout);
  try {
    int code = 0;
    if (own_code) {
      code = run_user_code("", [&] { return std::exchange(own_code, nullptr)(); });
    } else {
      serve(entity, peer.rules);
    }
    tell_unused(entity, peer, topics);
    return code;
  } catch (const std::exception& error) {
    tell_exception(peer, error);
    return kMissionFailed;
  }
}

}  // namespace

dds::Network network_of(const MissionProfile& mission, const PeerProfile& peer) {
  dds::Network network;
  network.allowed_sources = peer.allowed_sources;
  if (peer.interface.empty()) return network;
  network.interfaces = {peer.interface};
  network.multicast_discovery = peer.multicast;
  network.peers = peer.peers;
  if (!peer.peers.empty() || peer.multicast) return network;
  for (const std::string& host : hosts_of(mission)) {
    if (host != peer.host) network.peers.push_back(host);
  }
  return network;
}

EntityOptions entity_options(const MissionProfile& mission, const PeerProfile& peer) {
  EntityOptions options = options_of(mission, peer, peer);
  options.head = peer.head;
  return options;
}

int run_process(const MissionProfile& mission, const std::string& process,
                ComponentRegistry& registry) {
  const auto begun = std::chrono::steady_clock::now();
  report_crashes();
  set_log_sink(write_without_time);
  demand_address_space();
  const std::size_t slash = process.find('/');
  const PeerProfile* peer = mission.find_peer(process.substr(0, slash));
  if (!peer) refuse_process(mission, process);
  const CspProfile* csp =
      slash == std::string::npos ? nullptr : peer->find_csp(process.substr(slash + 1));
  if (slash != std::string::npos && !csp) refuse_process(mission, process);
  const std::string& program = csp ? csp->start.program : peer->start.program;
  if (!program.empty()) {
    throw InvalidArgument("'" + process + "' is a program of its own, '" + program +
                          "'; skein launch --dry-run says how it is started");
  }

  if (csp ? csp->threads.lock_memory : peer->threads.lock_memory) lock_memory();
  // A mission has no place at which it could notice a signal: it dies of it, as programs do.
  if (!peer->runs_mission) block_ending_signals();
  return csp ? run_csp(mission, *peer, *csp, registry) : run_peer(mission, *peer, registry, begun);
}

}  // namespace skein::launch
