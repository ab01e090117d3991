#include "brokerless_discovery/broker.hpp"

#include <unistd.h>

#include <atomic>
#include <random>
#include <utility>

#include "beat.hpp"
#include "brokerless_discovery/versions.hpp"
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

/// The parts of a Broker. Others' descriptions come in by `reader` on the vendor's thread, and
/// processes' ends by `processes` on the watch's. This peer's descriptions leave by `writer`, on
/// the thread that provides and on `control`. Locks are taken in the order writer, table,
/// observers.
struct Broker::State {
  State(dds::Participant& participant_, Clock& clock_, Executor& control, ProcessWatch& watch,
        Options options_)
      : participant(participant_),
        clock(clock_),
        options(std::move(options_)),
        observers(control, itself),
        table(clock, observers, asker),
        processes(watch, table, participant.guid(), itself),
        reader(participant, clock, control, table, processes, asker, options.lease, itself),
        writer(participant, table, observers, options.lease),
        beat(clock, control, options.lease, table, reader, writer, itself) {}

  dds::Participant& participant;
  Clock& clock;
  const Options options;
  const std::string asker = options.system + "/" + options.entity;
  std::weak_ptr<void> itself;  // for tasks and timers, which reach the parts only through it
  Observers observers;
  LockedTable table;
  DescribedProcesses processes;
  DescriptionReader reader;
  DescriptionWriter writer;
  Beat beat;
  std::atomic<std::uint32_t> last_provider{std::random_device{}()};
};

Broker::Broker(dds::Participant& participant, Clock& clock, Executor& control, ProcessWatch& watch,
               Options options) {
  check_name("a system", options.system);
  check_name("an entity", options.entity);
  state_ = std::make_shared<State>(participant, clock, control, watch, std::move(options));
  state_->itself = state_;
  state_->reader.open();
  state_->beat.start();
}

// The endpoints end here: the participant's end does not wait for the last owner of the state.
Broker::~Broker() {
  state_->reader.close();
  state_->writer.close();
  state_->beat.stop();
  state_->processes.close();
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
  description.host = state_->processes.host();
  description.process = state_->processes.own_address();
  description.pid = static_cast<std::uint32_t>(getpid());
  description.vendor = state_->options.vendor;
  if (description.system.empty()) description.system = state_->options.system;
  check_name("an entity or a CSP", description.entity);
  check_own(description, state_->participant.guid());
  const Guid provider{description.provider};
  state_->writer.add(std::move(description));
  return Registration([state = std::weak_ptr(state_), provider] {
    if (const auto self = state.lock()) self->writer.withdraw(provider);
  });
}

void Broker::leave(const Guid& provider) { state_->writer.leave(provider); }

bool Broker::is_leaving(const Guid& provider) const {
  return state_->table.look([&](const Table& table) { return table.is_leaving(provider); });
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
  return state_->table.look([&](const Table& table) { return table.find(query); });
}

Table::Found Broker::await_service(const Query& query, Instant deadline) const {
  const Instant now = state_->clock.now();
  const Duration asking = std::min<Duration>(kAskingPatience, (deadline - now) / 2);
  const LockedTable& table = state_->table;
  Table::Found found = table.await(query, query.client ? deadline - asking : deadline);
  if (!found.empty()) return found;
  const Query explained = with_differences(
      *this, query, deadline, [&] { return table.waits_ended() || !find_service(query).empty(); });
  found = table.await(explained, deadline);
  if (!found.empty()) return found;
  throw Unavailable(table.waits_ended()
                        ? "the entity that looked for it has ended"
                        : table.look([&](const Table& all) { return all.explain(explained); }));
}

bool Broker::await_change(std::uint64_t seen, Instant deadline) const {
  return state_->table.await_change(seen, deadline);
}

std::vector<Absence> Broker::absent(std::string_view service) const {
  return state_->table.absent(service);
}

void Broker::end_waits() { state_->table.end_waits(); }

std::string Broker::explain(const Query& query) const {
  const Query explained = with_differences(*this, query, state_->clock.now(), [] { return true; });
  return state_->table.look([&](const Table& table) { return table.explain(explained); });
}

std::string Broker::difference(const InterfaceInfo& client,
                               const ServiceDescription& provider) const {
  return asked_difference(*this, client, provider, state_->clock.now(), [] { return true; });
}

bool Broker::knows(const Guid& provider) const {
  return state_->table.look([&](const Table& table) { return table.knows(provider); });
}

std::optional<Guid> Broker::participant_of(const Guid& provider) const {
  const auto writer =
      state_->table.look([&](const Table& table) { return table.writer_of(provider); });
  if (!writer) return std::nullopt;
  return writer->is_nil() ? state_->participant.guid() : writer->participant();
}

std::uint64_t Broker::refused(Refusal why) const { return state_->reader.refused(why); }

Table::Found Broker::all() const {
  return state_->table.look([](const Table& table) { return table.all(); });
}

std::uint64_t Broker::generation() const noexcept { return state_->table.generation(); }

Broker::Registration Broker::observe(std::function<void(const Change&)> observer) {
  return Registration(
      [state = std::weak_ptr(state_), added = state_->observers.add(std::move(observer))] {
        if (const auto self = state.lock()) self->observers.remove(added);
      });
}

}  // namespace skein::brokerless_discovery
