#include <unistd.h>

#include <future>
#include <mutex>

#include "brokerless_discovery/broker.hpp"
#include "calls/plain_echo.hpp"
#include "calls/skein_peer.hpp"
#include "harness/census.hpp"
#include "harness/peer.hpp"
#include "harness/skipped.hpp"
#include "skein/entity.hpp"

namespace skein::benchmarks {
namespace {

/// `Options` are an entity's or a participant's.
template <class Options>
Options options_of(const SkeinPeer& peer) {
  Options options;
  options.name = "neighbour" + std::to_string(getpid());
  options.domain = peer.domain;
  options.network.max_participants = static_cast<std::uint32_t>(peer.peers);
  return options;
}

/// Outlives the wait: an observer may still be running when it is taken away.
struct Completion {
  std::promise<void> promise;
  std::once_flag told;
};

void await_services(brokerless_discovery::Broker& broker, std::size_t count) {
  const auto completion = std::make_shared<Completion>();
  const auto check = [&broker, completion, count](const brokerless_discovery::Change&) {
    if (broker.all().size() < count) return;
    std::call_once(completion->told, [&] { completion->promise.set_value(); });
  };
  const auto observation = broker.observe(check);
  check({});
  if (completion->promise.get_future().wait_for(kJoinPatience) == std::future_status::ready) return;
  throw Internal("found " + std::to_string(broker.all().size()) + " of " + std::to_string(count) +
                 " services");
}

}  // namespace

std::shared_ptr<dds::Vendor> load_or_skip(const std::string& vendor) {
  try {
    return dds::load_vendor(vendor);
  } catch (const Unavailable& error) {
    throw Skipped(error.what());
  }
}

void be_bystander(const SkeinPeer& peer) {
  const auto vendor = load_or_skip(peer.vendor);
  Census<Guid> known;
  auto options = options_of<dds::ParticipantOptions>(peer);
  options.on_participant = [&](const Guid& participant, bool present) {
    present ? known.add(participant) : known.remove(participant);
  };
  const auto participant = vendor->create_participant(options);
  known.await(peer.peers - 1);  // all but itself
  run_server();
}

void be_neighbour(const SkeinPeer& peer) {
  auto options = options_of<EntityOptions>(peer);
  options.vendor = load_or_skip(peer.vendor);
  Entity entity(options);
  entity.provide<benchmark::Echo>(std::make_shared<PlainEcho>());
  await_services(entity.broker(), peer.peers);
  run_server();
}

}  // namespace skein::benchmarks
