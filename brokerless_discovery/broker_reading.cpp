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
      return processes.settle(
          table.apply([&](Table& table) { return table.on_withdrawn(sample.key, sample.writer); }));
    }
    auto description = read(sample);
    const std::string process = processes.watch(description);
    const bool own = sample.writer.participant() == participant.guid();
    try {
      table.apply([&](Table& table) {
        // R24: withdrawn, and this is its description on a late way back.
        if (own && !table.knows(sample.key)) return Table::Changes{};
        return table.on_description(std::move(description), sample.writer);
      });
    } catch (const std::exception&) {
      processes.settle(process);
      throw;
    }
    processes.settle(process);
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
  if (refused[static_cast<std::size_t>(why)]++ > 0) return;
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
    processes.settle(table.apply([&](Table& table) { return table.on_writer_gone(writer); }));
    return renewals.lost(writer);
  }
  if (!renewals.matched(writer)) return;
  control.post([state = weak_from_this()] {
    if (const auto self = state.lock()) self->renew_if_due();
  });
}

void Broker::State::renew_if_due() {
  const bool suspects = table.look([](const Table& table) { return table.has_suspects(); });
  if (renewals.take_due(clock.now(), suspects)) renew_reader();
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
    table.apply([&](Table& table) { return table.on_writer_alive(writer, alive); });
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
  return renewals.may_ask_for_room(clock.now()) && table.take_room_again();
}

}  // namespace skein::brokerless_discovery
