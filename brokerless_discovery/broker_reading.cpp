#include "broker_state.hpp"
#include "core/log.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {
namespace {

// How many samples may wait while the reader is being made; later each is taken as it comes.
constexpr std::uint32_t kMaxWaiting = 4 * Room::kEntriesOfAll;

}  // namespace

void Broker::State::on_sample(const dds::Sample& sample) {
  try {
    if (sample.state == dds::InstanceState::Disposed) {
      return apply([&](Table& table) { return table.on_withdrawn(sample.key, sample.writer); });
    }
    auto description = read(sample);
    const bool watched = may_be_watched(description);
    const std::string process = description.process;
    if (watched) watch_process(process);
    const bool own = sample.writer.participant() == participant.guid();
    try {
      apply([&](Table& table) {
        // R24: withdrawn, and this is its description on a late way back.
        if (own && !table.knows(sample.key)) return Table::Changes{};
        return table.on_description(std::move(description), sample.writer);
      });
    } catch (const std::exception&) {
      if (watched) settle_watch(process);
      throw;
    }
    if (watched) settle_watch(process);
  } catch (const Refused& refusal) {
    refuse(refusal.why, sample.writer, refusal.what());
  } catch (const std::exception& error) {
    refuse(Refusal::Malformed, sample.writer, error.what());
  }
}

// What need not be read is not.
ServiceDescription Broker::State::read(const dds::Sample& sample) {
  if (!speaks_for(sample.writer, sample.key)) {
    throw Refused(Refusal::Forged, "its provider is another participant's");
  }
  if (sample.cdr.size() > kMaxDescriptionBytes) {
    throw Refused(Refusal::Oversized, "it has " + std::to_string(sample.cdr.size()) +
                                          " bytes, more than " +
                                          std::to_string(kMaxDescriptionBytes));
  }
  auto description = idl::decode_message<ServiceDescription>(sample.cdr);
  if (sample.key.bytes != description.provider) {
    throw Refused(Refusal::Malformed, "its key is not its provider");
  }
  check_description(description, sample.writer.participant());
  return description;
}

void Broker::State::refuse(Refusal why, const Guid& writer, const std::string& text) {
  std::lock_guard lock(mutex);
  if (++refused[static_cast<std::size_t>(why)] > 1) return;
  log(LogLevel::Warning, "broker",
      "refused a service description by participant " + writer.participant().hex().substr(0, 24) +
          ": " + text + "; further ones like it are counted and not logged");
}

// Of an older or a later version, or one that was given a longer lease.
void Broker::State::tell_unheard(const dds::Incompatibility& why) {
  if (told_unheard.exchange(true)) return;
  log(LogLevel::Warning, "broker",
      "the services of a peer stay unknown here: " + why.explanation +
          "; further peers like it are not logged");
}

void Broker::State::on_writer(const Guid& writer, bool matched) {
  if (!matched) {
    apply([&](Table& table) { return table.on_writer_gone(writer); });
    return renewals.lost(writer);
  }
  if (!renewals.matched(writer)) return;
  control.post([state = weak_from_this()] {
    if (const auto self = state.lock()) self->renew_if_due();
  });
}

void Broker::State::renew_if_due() {
  bool has_suspects;
  {
    std::lock_guard lock(mutex);
    has_suspects = table.has_suspects();
  }
  if (renewals.take_due(clock.now(), has_suspects)) renew_reader();
}

// R17: a writer that comes back need not know that it was gone, and some vendors do not deliver
// again what a reader has had from it. A new reader gets everything from everybody.
void Broker::State::renew_reader() {
  std::lock_guard lock(writing);
  if (closed) return;
  try {
    auto renewed = make_reader();
    reader.swap(renewed);
    renewals.renewed(clock.now());
  } catch (const Error& error) {
    log(LogLevel::Error, "broker",
        std::string("descriptions cannot be read again: ") + error.what());
  }
}

std::unique_ptr<dds::Reader> Broker::State::make_reader() {
  dds::ReaderListener listener;
  listener.on_data = [this](dds::Reader& source) {
    source.take([this](const dds::Sample& sample) { on_sample(sample); });
  };
  listener.on_matched = [this](const Guid& writer, bool matched) { on_writer(writer, matched); };
  listener.on_liveliness = [this](const Guid& writer, bool alive) {
    apply([&](Table& table) { return table.on_writer_alive(writer, alive); });
  };
  listener.on_incompatible = [this](const dds::Incompatibility& why) { tell_unheard(why); };
  // A reader that keeps the newest sample of each provider only would let anybody's take the place
  // of the provider's own.
  dds::Qos qos = description_qos({"", owner_partition(asker)}, options.lease);
  qos.history_depth = std::nullopt;
  qos.max_waiting = kMaxWaiting;
  return participant.create_reader(topic(), qos, std::move(listener));
}

// R26.
bool Broker::State::room_again() {
  if (!renewals.may_ask_for_room(clock.now())) return false;
  std::lock_guard lock(mutex);
  return table.take_room_again();
}

bool Broker::State::may_be_watched(const ServiceDescription& description) const {
  return description.host == host && !description.process.empty();
}

void Broker::State::watch_process(const std::string& process) {
  watch.watch(process, this, [state = weak_from_this(), process] {
    if (const auto self = state.lock()) {
      self->apply([&](Table& table) { return table.on_process_ended(process); });
    }
  });
}

// Whom nobody describes any more need not be watched; on whatever thread a description went while
// another came.
void Broker::State::settle_watch(const std::string& process) {
  const auto known = [&] {
    std::lock_guard lock(mutex);
    return table.knows_process(process);
  };
  if (!known()) watch.unwatch(process, this);
  if (known()) watch_process(process);
}

void Broker::State::settle_watches(const Table::Changes& changes) {
  std::set<std::string> processes;
  for (const Change& change : changes) {
    if (change.kind == Change::Kind::Removed && may_be_watched(*change.description)) {
      processes.insert(change.description->process);
    }
  }
  for (const std::string& process : processes) settle_watch(process);
}

}  // namespace skein::brokerless_discovery
