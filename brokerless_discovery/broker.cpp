#include "brokerless_discovery/broker.hpp"

#include <unistd.h>

#include "broker_state.hpp"
#include "brokerless_discovery/versions.hpp"
#include "core/clock_wait.hpp"
#include "core/printable.hpp"
#include "core/threads/sole_owner.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {
namespace {

constexpr std::chrono::seconds kAskingPatience{1};

void check_name(const std::string& what, const std::string& name) {
  if (is_name(name)) return;
  throw InvalidArgument("'" + printable(name) + "' is no name for " + what +
                        ": use letters, digits, '_', '-' and '.', 255 at most");
}

using GivesUp = std::function<bool()>;

// What goes wrong while a provider is asked, or in what it says, leaves the error as it is.
std::string asked_difference(const Broker& broker, const InterfaceInfo& client,
                             const ServiceDescription& provider, Instant deadline,
                             const GivesUp& gives_up) try {
  const auto participant = broker.participant_of({provider.provider});
  const auto& tell_types = broker.options().tell_types;
  const auto told =
      participant && tell_types ? tell_types(provider, *participant, deadline, gives_up) : nullptr;
  return told ? difference(client, provider, *told) : difference(client, provider);
} catch (const std::exception&) {
  return difference(client, provider);
}

/// Asks one provider for each difference that shows without its types.
Query with_differences(const Broker& broker, Query query, Instant deadline,
                       const GivesUp& gives_up) {
  if (!query.client) return query;
  Query of_any_version = query;
  of_any_version.client = nullptr;
  for (const auto& provider : broker.find_service(of_any_version)) {
    std::string plain = difference(*query.client, *provider);
    if (plain.empty() || query.differences.contains(plain)) continue;
    query.differences.emplace(
        std::move(plain), asked_difference(broker, *query.client, *provider, deadline, gives_up));
  }
  return query;
}

// Others would refuse it.
void check_own(const ServiceDescription& description, const Guid& participant) {
  try {
    check_description(description, participant);
    const std::size_t size = idl::encode_message(description).size();
    if (size <= kMaxDescriptionBytes) return;
    throw Refused(Refusal::Oversized, "it would have " + std::to_string(size) +
                                          " bytes, more than " +
                                          std::to_string(kMaxDescriptionBytes));
  } catch (const Refused& refusal) {
    throw InvalidArgument("the service " + description.service + " of " + description.entity +
                          " cannot be described to others: " + refusal.what());
  }
}

}  // namespace

const dds::Topic& Broker::State::topic() {
  static const dds::Topic topic{"skein/services", "skein::discovery::ServiceDescription", true};
  return topic;
}

dds::Qos Broker::State::description_qos(std::vector<std::string> partitions,
                                        std::chrono::milliseconds lease) {
  dds::Qos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  qos.liveliness_lease = lease;
  qos.partitions = std::move(partitions);
  return qos;
}

std::string Broker::State::owner_partition(const std::string& owner) { return "managed/" + owner; }

Table::Found Broker::State::await(const Query& query, Instant deadline) {
  std::unique_lock lock(mutex);
  Table::Found found;
  wait_until(clock, deadline, lock, changed, [&] {
    found = table.find(query);
    return leaving || !found.empty();
  });
  return found;
}

// One task for all changes that wait: a flood of them does not fill the executor, where one that
// finds no room would be lost.
void Broker::State::wake_teller() {
  const bool posted = control.post([state = weak_from_this()] {
    if (const auto self = state.lock()) self->tell();
  });
  if (posted) return;
  std::lock_guard lock(mutex);
  telling = false;  // the next change tries again
}

void Broker::State::tell() {
  std::vector<std::shared_ptr<Observer>> told;
  Table::Changes changes;
  {
    std::lock_guard lock(mutex);
    for (const auto& [id, observer] : observers) told.push_back(observer);
    changes.swap(untold);
    telling = false;
  }
  for (const Change& change : changes) {
    for (const auto& observer : told) {
      std::lock_guard lock(observer->telling);
      if (!observer->gone) observer->tell(change);
    }
  }
}

Broker::Broker(dds::Participant& participant, Clock& clock, Executor& control, ProcessWatch& watch,
               Options options) {
  check_name("a system", options.system);
  check_name("an entity", options.entity);
  state_ = std::make_shared<State>(participant, clock, control, watch, std::move(options));
  State& state = *state_;
  std::lock_guard lock(state.writing);
  state.reader = state.make_reader();
  state.last_tick = clock.now();
  state.arm();
}

Broker::~Broker() {
  TimerId timer;
  // They end here: the participant's end does not wait for whoever lets go of the state last.
  std::unique_ptr<dds::Reader> reader;
  std::map<std::string, std::unique_ptr<dds::Writer>> writers;
  std::string address;
  {
    std::lock_guard lock(state_->writing);
    state_->closed = true;
    state_->own.clear();
    address = state_->address;
    timer = state_->tick_timer;
    reader.swap(state_->reader);
    writers.swap(state_->writers);
  }
  state_->clock.cancel(timer);
  reader.reset();
  writers.clear();
  state_->watch.unwatch(state_.get());
  state_->watch.close(address);
  await_sole_owner(state_);
}

const Broker::Options& Broker::options() const noexcept { return state_->options; }

// The last byte is of no endpoint (RTPS 9.3.1.2), so that none has the identity.
Guid Broker::new_provider() {
  Guid provider = state_->participant.guid().participant();
  const std::uint32_t number = ++state_->last_provider;
  for (int i = 0; i < 3; ++i) {
    provider.bytes[12 + i] = static_cast<std::uint8_t>(number >> 8 * i);
  }
  return provider;
}

Broker::Registration Broker::add_service(ServiceDescription description) {
  description.host = state_->host;
  description.process = state_->watched_at();
  description.pid = static_cast<std::uint32_t>(getpid());
  description.vendor = state_->options.vendor;
  if (description.system.empty()) description.system = state_->options.system;
  check_name("an entity or a CSP", description.entity);
  check_own(description, state_->participant.guid());
  const Guid provider{description.provider};
  // Its own services a peer knows at once, whether or not its writer and its reader have matched.
  state_->apply([&](Table& table) { return table.on_description(description, Guid{}); });
  state_->publish(std::move(description));
  return state_->registration([provider](State& state) { state.withdraw(provider); });
}

void Broker::leave(const Guid& provider) { state_->leave(provider); }

bool Broker::is_leaving(const Guid& provider) const {
  std::lock_guard lock(state_->mutex);
  return state_->table.is_leaving(provider);
}

Query Broker::query(const std::string& name) const {
  Query query;
  query.name = name;
  query.system = state_->options.system;
  query.asker = state_->asker;
  query.place = state_->options.place;
  return query;
}

Table::Found Broker::find_service(const Query& query) const {
  std::lock_guard lock(state_->mutex);
  return state_->table.find(query);
}

Table::Found Broker::await_service(const Query& query, Instant deadline) const {
  const Instant now = state_->clock.now();
  const Duration asking = std::min<Duration>(kAskingPatience, (deadline - now) / 2);
  Table::Found found = state_->await(query, query.client ? deadline - asking : deadline);
  if (!found.empty()) return found;
  const Query explained = with_differences(*this, query, deadline, [&] {
    std::lock_guard lock(state_->mutex);
    return state_->leaving || !state_->table.find(query).empty();
  });
  found = state_->await(explained, deadline);
  if (!found.empty()) return found;
  std::lock_guard lock(state_->mutex);
  throw Unavailable(state_->leaving ? "the entity that looked for it has ended"
                                    : state_->table.explain(explained));
}

bool Broker::await_change(std::uint64_t seen, Instant deadline) const {
  std::unique_lock lock(state_->mutex);
  const bool changed = wait_until(state_->clock, deadline, lock, state_->changed,
                                  [&] { return state_->leaving || state_->generation != seen; });
  if (state_->leaving) throw Unavailable("the entity that waited for a service has ended");
  return changed;
}

std::vector<Absence> Broker::absent(std::string_view service) const {
  std::lock_guard lock(state_->mutex);
  return state_->absences.of(service);
}

void Broker::end_waits() {
  std::lock_guard lock(state_->mutex);
  state_->leaving = true;
  state_->changed.notify_all();
}

std::string Broker::explain(const Query& query) const {
  const Query explained = with_differences(*this, query, state_->clock.now(), [] { return true; });
  std::lock_guard lock(state_->mutex);
  return state_->table.explain(explained);
}

std::string Broker::difference(const InterfaceInfo& client,
                               const ServiceDescription& provider) const {
  return asked_difference(*this, client, provider, state_->clock.now(), [] { return true; });
}

bool Broker::knows(const Guid& provider) const {
  std::lock_guard lock(state_->mutex);
  return state_->table.knows(provider);
}

std::optional<Guid> Broker::participant_of(const Guid& provider) const {
  std::lock_guard lock(state_->mutex);
  const auto writer = state_->table.writer_of(provider);
  if (!writer) return std::nullopt;
  return writer->is_nil() ? state_->participant.guid() : writer->participant();
}

std::uint64_t Broker::refused(Refusal why) const {
  std::lock_guard lock(state_->mutex);
  return state_->refused[static_cast<std::size_t>(why)];
}

Table::Found Broker::all() const {
  std::lock_guard lock(state_->mutex);
  return state_->table.all();
}

std::uint64_t Broker::generation() const noexcept { return state_->generation; }

Broker::Registration Broker::observe(std::function<void(const Change&)> observer) {
  const auto added = std::make_shared<State::Observer>(std::move(observer));
  std::lock_guard lock(state_->mutex);
  const std::uint64_t id = ++state_->last_observer;
  state_->observers[id] = added;
  return state_->registration([id, added](State& state) {
    {
      std::lock_guard lock(state.mutex);
      state.observers.erase(id);
    }
    std::lock_guard lock(added->telling);
    added->gone = true;
  });
}

}  // namespace skein::brokerless_discovery
