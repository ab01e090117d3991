#include "description_reader.hpp"

#include <utility>

#include "core/log.hpp"
#include "description_topic.hpp"
#include "skein/detail/codec.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {
namespace {

// How many samples may wait while the reader is being made; later each is taken as it comes.
constexpr std::uint32_t kMaxWaiting = 4 * Room::kEntriesOfAll;

}  // namespace

void DescriptionReader::open() {
  std::lock_guard lock(mutex_);
  reader_ = make_reader();
}

void DescriptionReader::close() {
  std::unique_ptr<dds::Reader> reader;  // ends outside the lock
  std::lock_guard lock(mutex_);
  closed_ = true;
  reader.swap(reader_);
}

std::unique_ptr<dds::Reader> DescriptionReader::make_reader() {
  dds::ReaderListener listener;
  listener.on_data = [this](dds::Reader& source) {
    source.take([this](const dds::Sample& sample) { on_sample(sample); });
  };
  listener.on_matched = [this](const Guid& writer, bool matched) { on_writer(writer, matched); };
  listener.on_liveliness = [this](const Guid& writer, bool alive) {
    table_.apply([&](Table& table) { return table.on_writer_alive(writer, alive); });
  };
  listener.on_incompatible = [this](const dds::Incompatibility& why) { tell_unheard(why); };
  // A reader that keeps the newest sample of each provider only would let anybody's take the place
  // of the provider's own.
  dds::Qos qos = description_qos({"", description_partition(asker_)}, lease_);
  qos.history_depth = std::nullopt;
  qos.max_waiting = kMaxWaiting;
  return participant_.create_reader(description_topic(), qos, std::move(listener));
}

void DescriptionReader::on_sample(const dds::Sample& sample) {
  try {
    if (sample.state == dds::InstanceState::Disposed) {
      return processes_.settle(table_.apply(
          [&](Table& table) { return table.on_withdrawn(sample.key, sample.writer); }));
    }
    auto description = read(sample);
    if (has_other_wire(description)) tell_other_wire(description);
    const std::string process = processes_.watch(description);
    const bool own = sample.writer.participant() == participant_.guid();
    try {
      table_.apply([&](Table& table) {
        // R24: withdrawn, and this is its description on a late way back.
        if (own && !table.knows(sample.key)) return Table::Changes{};
        return table.on_description(std::move(description), sample.writer);
      });
    } catch (const std::exception&) {
      processes_.settle(process);
      throw;
    }
    processes_.settle(process);
  } catch (const Refused& refusal) {
    refuse(refusal.why, sample.writer, refusal.what());
  } catch (const std::exception& error) {
    refuse(Refusal::Malformed, sample.writer, error.what());
  }
}

// What need not be read is not.
ServiceDescription DescriptionReader::read(const dds::Sample& sample) {
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

void DescriptionReader::refuse(Refusal why, const Guid& writer, const std::string& text) {
  if (refused_[static_cast<std::size_t>(why)]++ > 0) return;
  log(LogLevel::Warning, "broker",
      "refused a service description by participant " + writer.participant().hex().substr(0, 24) +
          ": " + text + "; further ones like it are counted and not logged");
}

// Of an older or a later version, or one that was given a longer lease.
void DescriptionReader::tell_unheard(const dds::Incompatibility& why) {
  if (told_unheard_.exchange(true)) return;
  log(LogLevel::Warning, "broker",
      "the services of a peer stay unknown here: " + why.explanation +
          "; further peers like it are not logged");
}

void DescriptionReader::tell_other_wire(const ServiceDescription& description) {
  if (told_other_wire_.exchange(true)) return;
  log(LogLevel::Warning, "broker",
      description.entity + " (" + description.system + ") " + other_wire(description) +
          "; further peers like it are not logged");
}

void DescriptionReader::on_writer(const Guid& writer, bool matched) {
  if (!matched) {
    processes_.settle(table_.apply([&](Table& table) { return table.on_writer_gone(writer); }));
    return renewals_.lost(writer);
  }
  if (!renewals_.matched(writer)) return;
  control_.post([this, owner = owner_] {
    if (const auto kept = owner.lock()) renew_if_returned();
  });
}

void DescriptionReader::renew_if_due() {
  // R26.
  const bool room = renewals_.may_ask_for_room(clock_.now()) && table_.take_room_again();
  room ? renew() : renew_if_returned();
}

void DescriptionReader::renew_if_returned() {
  const bool suspects = table_.look([](const Table& table) { return table.has_suspects(); });
  if (renewals_.take_due(clock_.now(), suspects)) renew();
}

// R17: a writer that comes back need not know that it was gone, and some vendors do not deliver
// again what a reader has had from it. A new reader gets everything from everybody.
void DescriptionReader::renew() {
  std::lock_guard lock(mutex_);
  if (closed_) return;
  try {
    auto renewed = make_reader();
    reader_.swap(renewed);
    renewals_.renewed(clock_.now());
  } catch (const Error& error) {
    log(LogLevel::Error, "broker",
        std::string("descriptions cannot be read again: ") + error.what());
  }
}

}  // namespace skein::brokerless_discovery
