#include "broker_state.hpp"
#include "core/log.hpp"
#include "skein/detail/codec.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {

void Broker::State::publish(ServiceDescription description) {
  const Guid provider{description.provider};
  std::lock_guard lock(writing);
  Own& mine = own[provider];
  mine.message = idl::encode_message(description);
  mine.description = std::move(description);
  write(mine);
}

void Broker::State::write(const Own& mine) {
  auto& writer = writers[mine.description.owner];
  if (!writer) {
    const std::string& owner = mine.description.owner;
    writer = participant.create_writer(
        topic(), description_qos({owner.empty() ? "" : owner_partition(owner)}, options.lease));
  }
  writer->write(mine.message, {mine.description.provider});
}

// R28.
void Broker::State::leave(const Guid& provider) {
  ServiceDescription description;
  {
    std::lock_guard lock(writing);
    const auto mine = own.find(provider);
    if (mine == own.end()) return;
    description = mine->second.description;
  }
  mark_leaving(description);
  table.apply([&](Table& table) { return table.on_description(description, Guid{}); });
  publish(std::move(description));
}

void Broker::State::withdraw(const Guid& provider) {
  {
    std::lock_guard lock(writing);
    const auto node = own.extract(provider);
    if (!node) return;
    const auto& writer = writers[node.mapped().description.owner];
    try {
      writer->dispose(provider);
    } catch (const Error& error) {
      log(LogLevel::Warning, "broker", std::string("a withdrawal was not sent: ") + error.what());
    }
  }
  table.apply([&](Table& table) { return table.on_withdrawn(provider, Guid{}); });
}

// R17: a peer that slept through its lease is suspect to others, and on some vendors stays so
// until it writes again.
void Broker::State::tick() {
  room_again() ? renew_reader() : renew_if_due();
  const std::set<Guid> contradicted = table.take_contradicted();
  std::lock_guard lock(writing);
  if (closed) return;
  const Instant now = clock.now();
  const bool slept = now - last_tick > options.lease / 2;
  for (const auto& [provider, mine] : own) {
    if (slept || contradicted.contains(provider)) write_again(mine);
  }
  last_tick = now;
  arm();
}

void Broker::State::write_again(const Own& mine) {
  try {
    write(mine);
  } catch (const Error& error) {
    log(LogLevel::Warning, "broker",
        std::string("a description was not sent again: ") + error.what());
  }
}

void Broker::State::arm() {
  tick_timer = clock.call_after(options.lease / 4, [state = weak_from_this()] {
    const auto self = state.lock();
    if (!self) return;
    // One at a time, and to be lost never: whoever ticks sets the next.
    self->control.post_or_run([state] {
      if (const auto self = state.lock()) self->tick();
    });
  });
}

}  // namespace skein::brokerless_discovery
