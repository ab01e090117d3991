#include "fast_participant.hpp"

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>

#include <algorithm>
#include <atomic>

#include "attributes.hpp"
#include "core/log.hpp"
#include "core/system/network_interface.hpp"
#include "dds/port/options_check.hpp"
#include "dds/rtps/room_for_participant.hpp"
#include "fast_identity.hpp"
#include "fast_reader.hpp"
#include "fast_writer.hpp"
#include "liveliness.hpp"
#include "participant_leases.hpp"
#include "skein/error.hpp"

namespace skein::dds::fastdds {
namespace {

constexpr std::chrono::nanoseconds kShortestTick = std::chrono::milliseconds(2);

[[noreturn]] void throw_no_participant(const ParticipantOptions& options) {
  const std::string down = obstacle_of_this_host(options.network.interfaces, Carrier::Needed);
  throw Unavailable("no participant in domain " + std::to_string(options.domain) + ": " +
                    (down.empty() ? "Fast DDS found no free port; end other participants or use "
                                    "another domain"
                                  : down));
}

/// Without shared memory where there is no room.
ParticipantOptions feasible(ParticipantOptions options) {
  check_options(options);
  if (!options.network.shared_memory) return options;
  const auto reason = lacks_room_for_segments();
  if (!reason) return options;
  options.network.shared_memory = false;
  log(LogLevel::Warning, "dds/fastdds",
      "participant '" + options.name + "' does without shared memory: " + *reason +
          "; make room (`fastdds shm clean` removes what ended processes have left), or make it "
          "larger (mount -o remount,size=512m /dev/shm; docker run --shm-size=512m)");
  return options;
}

/// Fast DDS numbers all participants of a process's life, and ends the process beyond what it can
/// (participant_attributes).
void count_participant() {
  static std::atomic<std::uint32_t> made{0};
  constexpr std::uint32_t kMost = (65535 - kUserOffset) / 2;
  if (made.load() >= kMost || made.fetch_add(1) >= kMost) {
    throw Unavailable("this process has had " + std::to_string(kMost) +
                      " participants of Fast DDS, which numbers no more; start it anew, or keep "
                      "entities instead of making new ones");
  }
}

}  // namespace

FastParticipant::FastParticipant(const ParticipantOptions& options)
    : FastParticipant(options, SegmentsTurn(options.network.shared_memory)) {}

FastParticipant::FastParticipant(const ParticipantOptions& options, const SegmentsTurn&)
    : options_(feasible(options)),
      transport_(make_transport(options)),
      events_([this] { tick(); }) {
  transport_->state->watch.on_wake = [this] { events_.post([this] { forget_all(); }); };
  const auto attributes = participant_attributes(options_, transport_);
  require_room_for_participant(options_);
  count_participant();
  participant_ = rtps::RTPSDomain::createParticipant(options.domain, attributes, this);
  if (participant_ == nullptr) throw_no_participant(options);
  // Without a port Fast DDS goes on, deaf.
  const auto needed = std::ranges::count(attributes.defaultUnicastLocatorList, LOCATOR_KIND_UDPv4,
                                         &rtps::Locator_t::kind);
  if (transport_->state->ports < 2 * needed) {  // each address has a port for discovery, too
    end();
    throw_no_participant(options);
  }
  guid_ = to_guid(participant_->getGuid()).participant();
  transport_->state->discovery.opened(discovery_mutex(*participant_));
  transport_->state->open = true;
  if (options_.network.multicast_discovery) membership_.emplace(options_);
}

FastParticipant::~FastParticipant() {
  topics_.expect_unused(options_.name);
  end();
}

void FastParticipant::end() {
  {
    std::lock_guard lock(asserting_);
    assertion_period_.reset();
  }
  membership_.reset();
  transport_->state->discovery.close();
  rtps::RTPSDomain::removeRTPSParticipant(participant_);
}

void FastParticipant::onParticipantDiscovery(rtps::RTPSParticipant*,
                                             rtps::ParticipantDiscoveryInfo&& info) {
  using Info = rtps::ParticipantDiscoveryInfo;
  const bool present =
      info.status == Info::DISCOVERED_PARTICIPANT || info.status == Info::CHANGED_QOS_PARTICIPANT;
  const Guid guid = to_guid(info.info.m_guid).participant();
  if (info.status == Info::DISCOVERED_PARTICIPANT) {
    for (const auto& locator : info.info.metatraffic_locators.unicast) {
      transport_->state->pace.discovered(locator.port, std::chrono::steady_clock::now());
    }
  }
  if (present) {
    guard().found(guid);
    {
      std::lock_guard lock(mutex_);
      names_[guid] = info.info.m_participantName.to_string();
    }
    const auto& lease = info.info.m_leaseDuration;
    follow(guid, announced_lease(lease.seconds, lease.nanosec));
  } else {
    guard().removed(guid);
    {
      std::lock_guard lock(mutex_);
      names_.erase(guid);
    }
    signs().forget(guid);
  }
  if (info.status == Info::CHANGED_QOS_PARTICIPANT || !options_.on_participant) return;
  {
    std::lock_guard lock(mutex_);
    if (present ? !present_.insert(guid).second : present_.erase(guid) == 0) return;
  }
  events_.post([this, guid, present] { options_.on_participant(guid, present); });
}

void FastParticipant::onWriterDiscovery(rtps::RTPSParticipant*, rtps::WriterDiscoveryInfo&& info) {
  const Guid guid = to_guid(info.info.guid());
  if (info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER) return lost(guid);
  found(guid, to_endpoint(info.info));
}

void FastParticipant::onReaderDiscovery(rtps::RTPSParticipant*, rtps::ReaderDiscoveryInfo&& info) {
  const Guid guid = to_guid(info.info.guid());
  if (info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER) return lost(guid);
  found(guid, to_endpoint(info.info));
}

void FastParticipant::found(const Guid& guid, Endpoint endpoint) {
  guard().endpoint_found(guid);
  {
    std::lock_guard lock(mutex_);
    const auto name = names_.find(guid.participant());
    if (name != names_.end()) endpoint.participant = name->second;
  }
  endpoints_.found(guid, std::move(endpoint));
}

void FastParticipant::lost(const Guid& endpoint) {
  guard().endpoint_removed(endpoint);
  endpoints_.lost(endpoint);
}

void FastParticipant::follow(const Guid& participant,
                             std::optional<std::chrono::nanoseconds> lease) {
  signs().follow(participant, lease, std::chrono::steady_clock::now());
  if (lease) watch_each(*lease);
}

/// Often enough to see in time that `lease` ran out.
void FastParticipant::watch_each(std::chrono::nanoseconds lease) {
  constexpr int kChecksInALease = 20;
  const auto period = std::max(lease / kChecksInALease, kShortestTick);
  {
    std::lock_guard lock(mutex_);
    watch_period_ = std::min(watch_period_, period);
  }
  events_.tick_every(period);
}

void FastParticipant::watch_liveliness(std::weak_ptr<EndpointEvents> reader,
                                       std::chrono::nanoseconds lease) {
  {
    std::lock_guard lock(mutex_);
    watched_.push_back({std::move(reader), lease});
  }
  watch_each(lease);
}

void FastParticipant::assert_liveliness_for(std::chrono::nanoseconds lease) {
  const auto period = lease * 2 / 5;
  {
    std::lock_guard lock(asserting_);
    assertion_period_ = std::min(assertion_period_.value_or(period), period);
  }
  events_.tick_every(std::max(period / 4, kShortestTick));
}

void FastParticipant::assert_liveliness_if_due() {
  const auto now = std::chrono::steady_clock::now();
  std::lock_guard lock(asserting_);
  if (!assertion_period_ || now - last_assertion_ < *assertion_period_) return;
  last_assertion_ = now;
  assert_liveliness(*participant_);
}

void FastParticipant::tick() {
  assert_liveliness_if_due();
  check_leases();
  check_liveliness();
  drop_incomplete();
}

void FastParticipant::remove(FastReader& reader) {
  all_readers_.erase(&reader);
  guard().reader_gone(rtps_message::entity_of(reader.guid()));
}

/// Fast DDS keeps the memory of a sample in fragments for as long as its writer is there.
void FastParticipant::drop_incomplete() {
  for (const auto& sample : guard().give_up(std::chrono::steady_clock::now())) {
    Guid writer = sample.participant;
    rtps_message::put32(writer.bytes.data() + rtps_message::kPrefixSize, sample.writer, false);
    {
      std::lock_guard lock(readers_);
      for (FastReader* const reader : all_readers_) reader->drop_incomplete(writer, sample.number);
    }
    guard().dropped(sample);
  }
}

void FastParticipant::check_leases() {
  std::chrono::nanoseconds period;
  {
    std::lock_guard lock(mutex_);
    period = watch_period_;
  }
  for (const Guid& gone : signs().watch(std::chrono::steady_clock::now(), period)) {
    transport_->state->discovery.say_farewell(gone);
  }
}

void FastParticipant::forget_all() {
  for (const Guid& each : signs().drop_all()) transport_->state->discovery.say_farewell(each);
  transport_->state->watch.awake(std::chrono::steady_clock::now());
}

void FastParticipant::check_liveliness() {
  std::vector<Watched> watched;
  {
    std::lock_guard lock(mutex_);
    std::erase_if(watched_, [](const Watched& each) { return each.reader.expired(); });
    watched = watched_;
  }
  const auto now = std::chrono::steady_clock::now();
  for (const Watched& each : watched) {
    const auto reader = each.reader.lock();
    if (!reader) continue;
    for (const Guid& writer : reader->peers()) {
      reader->alive(writer, signs().alive(writer.participant(), each.lease, now));
    }
  }
}

int FastParticipant::acquire_topic(const Topic& topic) {
  return topics_.acquire(topic, [] { return 0; });
}

void FastParticipant::release_topic(const std::string& name) {
  topics_.release(name, [](int) {});
}

std::unique_ptr<Writer> FastParticipant::create_writer(const Topic& topic, const Qos& qos,
                                                       WriterListener listener) {
  check_qos(topic, qos);
  return std::make_unique<FastWriter>(*this, topic, qos, std::move(listener));
}

std::unique_ptr<Reader> FastParticipant::create_reader(const Topic& topic, const Qos& qos,
                                                       ReaderListener listener) {
  check_qos(topic, qos);
  return std::make_unique<FastReader>(*this, topic, qos, std::move(listener));
}

}  // namespace skein::dds::fastdds
