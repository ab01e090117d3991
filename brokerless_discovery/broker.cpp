#include "skein/brokerless_discovery/broker.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>

#include "skein/brokerless_discovery/process_watch.hpp"
#include "skein/core/error.hpp"
#include "skein/core/log.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/idl/codec.hpp"

namespace skein::brokerless_discovery {
namespace {

const dds::Topic kTopic{"skein/services", "skein::discovery::ServiceDescription", true};

// How many writers that have gone are remembered, in case that one of them comes back.
constexpr std::size_t kMaxLostWriters = 4096;

dds::Qos description_qos(std::vector<std::string> partitions, std::chrono::milliseconds lease) {
  dds::Qos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  qos.liveliness_lease = lease;
  qos.partitions = std::move(partitions);
  return qos;
}

std::string owner_partition(const std::string& owner) { return "managed/" + owner; }

// What may stand in a partition's name on every vendor, and in a topic.
void check_name(const std::string& what, const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (!name.empty() && std::all_of(name.begin(), name.end(), allowed)) return;
  throw InvalidArgument("'" + name + "' is no name for " + what +
                        ": use letters, digits, '_', '-' and '.'");
}

}  // namespace

struct Broker::State : std::enable_shared_from_this<State> {
  using Observer = std::function<void(const Change&)>;

  struct Own {
    ServiceDescription description;
    Bytes message;
  };

  State(dds::Participant& participant_, Clock& clock_, Executor& control_, ProcessWatch& watch_,
        Options options_)
      : participant(participant_),
        clock(clock_),
        control(control_),
        watch(watch_),
        options(std::move(options_)) {}

  dds::Participant& participant;
  Clock& clock;
  Executor& control;
  ProcessWatch& watch;
  const Options options;
  const std::string asker = options.system + "/" + options.entity;
  const std::string host = ProcessWatch::host();

  mutable std::mutex mutex;
  mutable std::condition_variable changed;
  bool leaving = false;  // nobody waits for services any more
  Table table;
  std::atomic<std::uint64_t> generation{0};  // written under the lock
  std::map<std::uint64_t, std::shared_ptr<Observer>> observers;
  std::uint64_t last_observer = 0;
  std::uint64_t malformed = 0;

  std::mutex writing;  // guards what follows; taken before `mutex` where both are
  std::map<Guid, Own> own;
  std::map<std::string, std::unique_ptr<dds::Writer>> writers;  // by owner; "" for public services
  Instant last_tick{};
  Instant last_renewal{};
  TimerId tick_timer = 0;
  bool closed = false;
  std::unique_ptr<dds::Reader> reader;

  std::set<Guid> lost_writers;  // guarded by `mutex`

  // ---- what others tell

  void on_sample(const dds::Sample& sample) {
    if (sample.state == dds::InstanceState::Disposed) {
      return apply([&](Table& table) { return table.on_withdrawn(sample.key); });
    }
    try {
      auto description = idl::decode_message<ServiceDescription>(sample.cdr);
      watch_process(description);
      apply([&](Table& table) {
        return table.on_description(std::move(description), sample.writer);
      });
    } catch (const std::exception& error) {
      std::lock_guard lock(mutex);
      if (++malformed > 1) return;
      log(LogLevel::Warning, "broker",
          std::string("dropped a malformed service description: ") + error.what());
    }
  }

  void on_writer(const Guid& writer, bool matched) {
    if (!matched) apply([&](Table& table) { return table.on_writer_gone(writer); });
    {
      std::lock_guard lock(mutex);
      if (!matched) {
        if (lost_writers.size() >= kMaxLostWriters) lost_writers.erase(lost_writers.begin());
        lost_writers.insert(writer);
        return;
      }
      if (lost_writers.erase(writer) == 0) return;
    }
    control.post([state = weak_from_this()] {
      if (const auto self = state.lock()) self->renew_reader();
    });
  }

  // R17: a writer that comes back need not know that it was gone, and some vendors do not deliver
  // again what a reader has had from it. A new reader gets everything from everybody.
  void renew_reader() {
    std::lock_guard lock(writing);
    if (closed) return;
    try {
      auto renewed = make_reader();
      reader.swap(renewed);
      last_renewal = clock.now();
    } catch (const Error& error) {
      log(LogLevel::Error, "broker",
          std::string("descriptions cannot be read again: ") + error.what());
    }
  }

  std::unique_ptr<dds::Reader> make_reader() {
    dds::ReaderListener listener;
    listener.on_data = [this](dds::Reader& source) {
      source.take([this](const dds::Sample& sample) { on_sample(sample); });
    };
    listener.on_matched = [this](const Guid& writer, bool matched) { on_writer(writer, matched); };
    listener.on_liveliness = [this](const Guid& writer, bool alive) {
      apply([&](Table& table) { return table.on_writer_alive(writer, alive); });
    };
    return participant.create_reader(
        kTopic, description_qos({"", owner_partition(asker)}, options.lease), std::move(listener));
  }

  void watch_process(const ServiceDescription& description) {
    if (description.host != host || description.process.empty() ||
        description.process == watch.address()) {
      return;
    }
    watch.watch(description.process, [state = weak_from_this(), process = description.process] {
      if (const auto self = state.lock()) {
        self->apply([&](Table& table) { return table.on_process_ended(process); });
      }
    });
  }

  template <class Event>
  void apply(Event event) {
    Table::Changes changes;
    {
      std::lock_guard lock(mutex);
      changes = event(table);
      if (changes.empty()) return;
      ++generation;
      changed.notify_all();
      if (observers.empty()) return;
    }
    control.post([state = weak_from_this(), changes = std::move(changes)] {
      if (const auto self = state.lock()) self->tell(changes);
    });
  }

  void tell(const Table::Changes& changes) {
    std::vector<std::shared_ptr<Observer>> told;
    {
      std::lock_guard lock(mutex);
      for (const auto& [id, observer] : observers) told.push_back(observer);
    }
    for (const Change& change : changes) {
      for (const auto& observer : told) (*observer)(change);
    }
  }

  // ---- what this peer tells

  void publish(ServiceDescription description) {
    const Guid provider{description.provider};
    std::lock_guard lock(writing);
    Own& mine = own[provider];
    mine.message = idl::encode_message(description);
    mine.description = std::move(description);
    write(mine);
  }

  void write(const Own& mine) {
    auto& writer = writers[mine.description.owner];
    if (!writer) {
      const std::string& owner = mine.description.owner;
      writer = participant.create_writer(
          kTopic, description_qos({owner.empty() ? "" : owner_partition(owner)}, options.lease));
    }
    writer->write(mine.message, {mine.description.provider});
  }

  void withdraw(const Guid& provider) {
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
    apply([&](Table& table) { return table.on_withdrawn(provider); });
  }

  // R17: a peer that slept through its lease is suspect to others, and on some vendors stays so
  // until it writes again.
  void tick() {
    if (suspects_stay()) renew_reader();
    std::lock_guard lock(writing);
    if (closed) return;
    const Instant now = clock.now();
    if (now - last_tick > options.lease / 2) {
      for (const auto& [provider, mine] : own) {
        try {
          write(mine);
        } catch (const Error& error) {
          log(LogLevel::Warning, "broker",
              std::string("a description was not sent again: ") + error.what());
        }
      }
    }
    last_tick = now;
    arm();
  }

  // A writer that is alive again is not reported as such by every vendor.
  bool suspects_stay() {
    std::lock_guard lock(writing);
    if (clock.now() - last_renewal < options.lease) return false;
    std::lock_guard table_lock(mutex);
    return table.has_suspects();
  }

  void arm() {
    tick_timer = clock.call_after(options.lease / 4, [state = weak_from_this()] {
      const auto self = state.lock();
      if (!self) return;
      self->control.post([state] {
        if (const auto self = state.lock()) self->tick();
      });
    });
  }

  Registration registration(std::function<void(State&)> end) {
    return Registration([state = weak_from_this(), end = std::move(end)] {
      if (const auto self = state.lock()) end(*self);
    });
  }
};

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
  std::unique_ptr<dds::Reader> reader;
  {
    std::lock_guard lock(state_->writing);
    state_->closed = true;
    timer = state_->tick_timer;
    reader.swap(state_->reader);
  }
  state_->clock.cancel(timer);
  reader.reset();
}

const Broker::Options& Broker::options() const noexcept { return state_->options; }

Broker::Registration Broker::add_service(ServiceDescription description) {
  description.host = state_->host;
  description.process = state_->watch.address();
  description.pid = static_cast<std::uint32_t>(getpid());
  description.vendor = state_->options.vendor;
  if (description.system.empty()) description.system = state_->options.system;
  check_name("an entity or a CSP", description.entity);
  const Guid provider{description.provider};
  // Its own services a peer knows at once, whether or not its writer and its reader have matched.
  state_->apply([&](Table& table) { return table.on_description(description, Guid{}); });
  state_->publish(std::move(description));
  return state_->registration([provider](State& state) { state.withdraw(provider); });
}

Query Broker::query(const std::string& name) const {
  Query query;
  query.name = name;
  query.system = state_->options.system;
  query.asker = state_->asker;
  return query;
}

Table::Found Broker::find_service(const Query& query) const {
  std::lock_guard lock(state_->mutex);
  return state_->table.find(query);
}

Table::Found Broker::await_service(const Query& query, Instant deadline) const {
  std::unique_lock lock(state_->mutex);
  bool late = false;
  const TimerId timer = state_->clock.call_at(deadline, [state = state_, &late] {
    std::lock_guard lock(state->mutex);
    late = true;
    state->changed.notify_all();
  });
  Table::Found found;
  std::string reason;
  try {
    state_->changed.wait(lock, [&] {
      found = state_->table.find(query);
      return late || state_->leaving || !found.empty() || state_->clock.now() >= deadline;
    });
    if (found.empty()) {
      reason = state_->leaving ? "the entity that looked for it has ended"
                               : state_->table.explain(query);
    }
  } catch (...) {
    lock.unlock();
    state_->clock.cancel(timer);
    throw;
  }
  lock.unlock();
  state_->clock.cancel(timer);
  if (found.empty()) throw Unavailable(reason);
  return found;
}

void Broker::end_waits() {
  std::lock_guard lock(state_->mutex);
  state_->leaving = true;
  state_->changed.notify_all();
}

std::string Broker::explain(const Query& query) const {
  std::lock_guard lock(state_->mutex);
  return state_->table.explain(query);
}

bool Broker::knows(const Guid& provider) const {
  std::lock_guard lock(state_->mutex);
  return state_->table.knows(provider);
}

std::uint64_t Broker::malformed() const {
  std::lock_guard lock(state_->mutex);
  return state_->malformed;
}

Table::Found Broker::all() const {
  std::lock_guard lock(state_->mutex);
  return state_->table.all();
}

std::uint64_t Broker::generation() const noexcept { return state_->generation; }

Broker::Registration Broker::observe(std::function<void(const Change&)> observer) {
  std::lock_guard lock(state_->mutex);
  const std::uint64_t id = ++state_->last_observer;
  state_->observers[id] = std::make_shared<State::Observer>(std::move(observer));
  return state_->registration([id](State& state) {
    std::lock_guard lock(state.mutex);
    state.observers.erase(id);
  });
}

}  // namespace skein::brokerless_discovery
