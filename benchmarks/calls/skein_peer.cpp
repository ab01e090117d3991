#include "calls/skein_peer.hpp"

#include <future>
#include <random>
#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "calls/alone.hpp"
#include "echo.idl.hpp"
#include "harness/peer.hpp"
#include "harness/skipped.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/entity.hpp"

namespace skein::benchmarks {
namespace {

using benchmark::Echo;
using namespace std::chrono_literals;

constexpr std::uint32_t kMaxParticipants = 4;
// A thousand connections come from a dozen processes.
constexpr std::uint32_t kMaxParticipantsWithMany = 16;

class EchoBody final : public Echo {
 public:
  Content echo(const Content& content) override { return benchmarks::echo(content); }
  void hold() override {
    holding_ = true;
    while (!CallContext::current()->cancelled()) std::this_thread::sleep_for(5ms);
    holding_ = false;
  }
  bool holding() override { return holding_; }

 private:
  std::atomic<bool> holding_{false};
};

void serve(const SkeinPeer& peer) {
  Entity entity(entity_options(peer));
  ServiceOptions options;
  options.threads = peer.threads;
  entity.provide<Echo>(std::make_shared<EchoBody>(), options);
  run_server();
}

/// A call that is pending when its provider dies.
class Held {
 public:
  Held(Entity& entity, Echo::Proxy& proxy) : entity_(entity), proxy_(proxy) {}

  std::string hold() {
    observation_ = entity_.broker().observe([this](const brokerless_discovery::Change& change) {
      if (change.kind == brokerless_discovery::Change::Kind::Removed)
        removed_.set_value(now_text());
    });
    call_.emplace(proxy_.within(60s).async_hold());
    while (!proxy_.holding()) std::this_thread::sleep_for(1ms);
    return "holding";
  }

  std::string told() {
    try {
      call_->get();
    } catch (const Disconnected&) {
      const std::string ended = now_text();
      return "told " + ended + " " + removed_.get_future().get();
    }
    throw Internal("the call to a killed provider returned");
  }

 private:
  Entity& entity_;
  Echo::Proxy& proxy_;
  std::optional<Call<void>> call_;
  std::promise<std::string> removed_;
  brokerless_discovery::Broker::Registration observation_;
};

Echo::Proxy connected(Entity& entity) {
  auto proxy = entity.connect<Echo>({.timeout = 20s}).within(10s);
  proxy.echo({});
  return proxy;
}

EchoCall call_of(const Echo::Proxy& made) {
  return [proxy = made](const Content& content, const Seen& seen) mutable {
    seen(proxy.echo(content));
  };
}

Client client_of(Entity& entity, const Echo::Proxy& made) {
  return {call_of(made), [&entity] { return call_of(connected(entity)); },
          [proxy = made](const Content& content) mutable {
            auto call = std::make_shared<Call<Content>>(proxy.async_echo(content));
            return [call] { call->get(); };
          }};
}

void call(const SkeinPeer& peer) {
  Entity entity(entity_options(peer));
  auto proxy = connected(entity);
  Held held(entity, proxy);
  Client client = client_of(entity, proxy);
  client.extra = {{"hold", [&](const std::string&) { return held.hold(); }},
                  {"told", [&](const std::string&) { return held.told(); }}};
  run_client(client);
}

/// Both ends in one process: the transport without DDS.
void call_in_process() {
  Alone alone;
  alone.entity->provide<Echo>(std::make_shared<EchoBody>(), {.thread = CallThread::Caller});
  run_client(client_of(*alone.entity, connected(*alone.entity)));
}

std::string service_name(std::size_t number) {
  return "benchmark/IService" + std::to_string(number);
}

/// Of all services that `Finder` binds.
constexpr const char* kCommonBase = "benchmark/IService";

/// A Broker with many descriptions, and how long it takes to find one: by a name that it alone has,
/// or among all by what it alone declares.
class Finder {
 public:
  explicit Finder(brokerless_discovery::Broker& broker) : broker_(broker) {}

  std::string bind(std::size_t count) {
    while (registrations_.size() < count) {
      brokerless_discovery::ServiceDescription description;
      description.provider = broker_.new_provider().bytes;
      description.service = service_name(registrations_.size());
      description.bases = {kCommonBase};
      description.entity = "entity" + std::to_string(registrations_.size());
      description.attributes = {{"latency", std::to_string(registrations_.size())},
                                {"quality", "1.0"}};
      registrations_.push_back(broker_.add_service(description));
    }
    while (broker_.all().size() < count) std::this_thread::sleep_for(1ms);
    return "bound";
  }

  std::string find(std::size_t count) {
    return timed(count, [&](std::size_t number) {
      return
          [this, name = service_name(number)] { return broker_.find_service(broker_.query(name)); };
    });
  }

  std::string choose(std::size_t count) {
    return timed(count, [&](std::size_t number) {
      using namespace brokerless_discovery;
      const std::vector<Constraint> constraints{
          {"quality", Relation::AtLeast, "0.5"},
          {"latency", Relation::Equal, std::to_string(number)}};
      return [this, constraints] {
        auto query = broker_.query(kCommonBase);
        query.constraints = constraints;
        return broker_.find_service(query);
      };
    });
  }

 private:
  template <class MakeSearch>
  std::string timed(std::size_t count, MakeSearch make_search) {
    std::mt19937 random(1);
    std::string times = "times";
    for (std::size_t i = 0; i < count; ++i) {
      const auto search = make_search(random() % registrations_.size());
      const auto begin = std::chrono::steady_clock::now();
      const auto found = search();
      const auto took = std::chrono::steady_clock::now() - begin;
      if (found.size() != 1) throw Internal("what was looked for was not found");
      times += ' ' + std::to_string(std::chrono::nanoseconds(took).count());
    }
    return times;
  }

  brokerless_discovery::Broker& broker_;
  std::vector<brokerless_discovery::Broker::Registration> registrations_;
};

void find_services() {
  Alone alone;
  Finder finder(alone.entity->broker());
  run_commands(
      {{"bind", [&](const std::string& count) { return finder.bind(std::stoul(count)); }},
       {"find", [&](const std::string& count) { return finder.find(std::stoul(count)); }},
       {"choose", [&](const std::string& count) { return finder.choose(std::stoul(count)); }}});
}

}  // namespace

EntityOptions entity_options(const SkeinPeer& peer) {
  EntityOptions options;
  options.name = peer.role;
  options.vendor = load_or_skip(peer.vendor);
  options.domain = peer.domain;
  options.shared_memory_calls = peer.shared_memory;
  options.spin = std::chrono::microseconds(peer.spin_us);
  options.network.max_participants =
      peer.shared_memory ? kMaxParticipantsWithMany : kMaxParticipants;
  if (!peer.interface.empty()) {
    options.network.interfaces = {peer.interface};
    options.network.peers = {peer.peer};
  }
  return options;
}

int run_skein_peer(const SkeinPeer& peer) {
  return run_peer([&] {
    if (peer.survives) return survive(peer);
    if (peer.role == "server") return serve(peer);
    if (peer.role == "viewer") return view(peer);
    if (peer.role == "lender") return lend(peer);
    if (peer.role == "finder") return find_services();
    if (peer.role == "head") return perform_tasks();
    if (peer.role == "neighbour") return be_neighbour(peer);
    if (peer.role == "bystander") return be_bystander(peer);
    if (peer.role == "recorder") return record(entity_options(peer));
    if (peer.role == "counter") return count(entity_options(peer));
    if (peer.role == "publisher") return publish(entity_options(peer));
    peer.role == "local" ? call_in_process() : call(peer);
  });
}

}  // namespace skein::benchmarks
