#include "fast_participant.hpp"

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
#include "skein/error.hpp"

namespace skein::dds::fastdds {
namespace {

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
      readers_(transport_->state->guard),
      assertions_([this] { assert_liveliness(*participant_); }),
      silence_(*transport_->state, events_),
      discovery_(options_, *transport_->state, silence_, events_),
      events_([this] { tick(); }) {
  const auto attributes = participant_attributes(options_, transport_);
  require_room_for_participant(options_);
  count_participant();
  participant_ = rtps::RTPSDomain::createParticipant(options.domain, attributes, &discovery_);
  if (participant_ == nullptr) throw_no_participant(options);
  // Without a port Fast DDS goes on, deaf.
  const auto needed = std::ranges::count(attributes.defaultUnicastLocatorList, LOCATOR_KIND_UDPv4,
                                         &rtps::Locator_t::kind);
  if (transport_->state->ports < 2 * needed) {  // each address has a port for discovery, too
    end();
    throw_no_participant(options);
  }
  guid_ = to_guid(participant_->getGuid()).participant();
  transport_->state->open = true;
  if (!options_.network.multicast_discovery) return;
  try {
    membership_.emplace(options_);
  } catch (...) {
    end();  // Fast DDS's threads call this object's parts until then
    throw;
  }
}

FastParticipant::~FastParticipant() {
  topics_.expect_unused(options_.name);
  end();
}

void FastParticipant::end() {
  assertions_.end();
  membership_.reset();
  transport_->state->discovery.close();
  rtps::RTPSDomain::removeRTPSParticipant(participant_);
}

void FastParticipant::tick() {
  assertions_.assert_if_due(std::chrono::steady_clock::now());
  silence_.check(std::chrono::steady_clock::now());
  readers_.drop_incomplete(std::chrono::steady_clock::now());
}

void FastParticipant::assert_liveliness_for(std::chrono::nanoseconds lease) {
  events_.tick_every(std::max(assertions_.begin(lease), EventThread::kShortestTick));
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
