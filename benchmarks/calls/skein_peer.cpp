#include "calls/skein_peer.hpp"

#include <future>
#include <thread>

#include "echo.idl.hpp"
#include "harness/peer.hpp"
#include "harness/skipped.hpp"
#include "skein/brokerless_discovery/broker.hpp"
#include "skein/entity/entity.hpp"

namespace skein::benchmarks {
namespace {

using benchmark::Echo;
using namespace std::chrono_literals;

constexpr std::uint32_t kMaxParticipants = 4;

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

std::shared_ptr<dds::Vendor> load(const std::string& vendor) {
  try {
    return dds::load_vendor(vendor);
  } catch (const Unavailable& error) {
    throw Skipped(error.what());
  }
}

EntityOptions entity_options(const SkeinPeer& peer) {
  EntityOptions options;
  options.name = peer.role;
  options.vendor = load(peer.vendor);
  options.domain = peer.domain;
  options.network.max_participants = kMaxParticipants;
  if (!peer.interface.empty()) {
    options.network.interfaces = {peer.interface};
    options.network.peers = {peer.peer};
  }
  return options;
}

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
      if (change.kind == brokerless_discovery::Change::Kind::Removed) removed_.set_value(now_text());
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

void call(const SkeinPeer& peer) {
  Entity entity(entity_options(peer));
  auto proxy = entity.connect<Echo>({.timeout = 20s}).within(10s);
  proxy.echo({});
  Held held(entity, proxy);
  run_client([&](const Content& content) { return proxy.echo(content); },
             {{"hold", [&](const std::string&) { return held.hold(); }},
              {"told", [&](const std::string&) { return held.told(); }}});
}

}  // namespace

int run_skein_peer(const SkeinPeer& peer) {
  return run_peer([&] { peer.role == "server" ? serve(peer) : call(peer); });
}

}  // namespace skein::benchmarks
