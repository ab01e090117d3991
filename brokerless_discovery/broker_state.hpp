#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <utility>

#include "brokerless_discovery/broker.hpp"
#include "brokerless_discovery/process_watch.hpp"
#include "renewals.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::brokerless_discovery {

/// Binds the table to the port. What others tell comes in on the vendor's thread and on the
/// watch's (broker_reading.cpp), what this peer tells leaves from whoever provides and from
/// `control` (broker_writing.cpp); observers are told on `control` (broker.cpp).
struct Broker::State : std::enable_shared_from_this<State> {
  /// Once gone, it is not called any more. Recursive, so that an observer may let itself go.
  struct Observer {
    explicit Observer(std::function<void(const Change&)> tell_) : tell(std::move(tell_)) {}
    const std::function<void(const Change&)> tell;
    std::recursive_mutex telling;
    bool gone = false;
  };

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
  Departures absences;
  std::atomic<std::uint64_t> generation{0};  // written under the lock
  std::map<std::uint64_t, std::shared_ptr<Observer>> observers;
  std::uint64_t last_observer = 0;
  Table::Changes untold;
  bool telling = false;                            // a task on `control` will tell them
  std::array<std::uint64_t, kRefusals> refused{};  // by Refusal
  std::atomic<bool> told_unheard{false};           // of a writer that no reader here hears

  std::mutex writing;  // guards what follows; taken before `mutex` where both are
  std::map<Guid, Own> own;
  std::map<std::string, std::unique_ptr<dds::Writer>> writers;  // by owner; "" for public services
  Instant last_tick{};
  TimerId tick_timer = 0;
  bool closed = false;
  std::unique_ptr<dds::Reader> reader;

  Renewals renewals{options.lease, clock.now()};
  std::string address;  // where others watch this process; guarded by `writing`
  std::atomic<std::uint32_t> last_provider{std::random_device{}()};

  static const dds::Topic& topic();
  static dds::Qos description_qos(std::vector<std::string> partitions,
                                  std::chrono::milliseconds lease);
  static std::string owner_partition(const std::string& owner);

  Registration registration(std::function<void(State&)> end) {
    return Registration([state = weak_from_this(), end = std::move(end)] {
      if (const auto self = state.lock()) end(*self);
    });
  }

  // ---- the table and its observers
  template <class Event>
  void apply(Event event) {
    Table::Changes changes;
    bool wake = false;
    {
      std::lock_guard lock(mutex);
      changes = event(table);
      if (changes.empty()) return;
      absences.note(changes, asker, clock.now());
      ++generation;
      changed.notify_all();
      if (!observers.empty()) {
        untold.insert(untold.end(), changes.begin(), changes.end());
        wake = !std::exchange(telling, true);
      }
    }
    if (wake) wake_teller();
    settle_watches(changes);
  }

  void wake_teller();
  void tell();
  /// Waits until there is one, until the entity ends, or until `deadline`.
  Table::Found await(const Query& query, Instant deadline);

  // ---- what others tell
  void on_sample(const dds::Sample& sample);
  static ServiceDescription read(const dds::Sample& sample);
  void refuse(Refusal why, const Guid& writer, const std::string& text);
  void tell_unheard(const dds::Incompatibility& why);
  void on_writer(const Guid& writer, bool matched);
  void renew_if_due();
  void renew_reader();
  std::unique_ptr<dds::Reader> make_reader();
  bool room_again();
  bool may_be_watched(const ServiceDescription& description) const;
  void watch_process(const std::string& process);
  void settle_watch(const std::string& process);
  void settle_watches(const Table::Changes& changes);

  // ---- what this peer tells
  const std::string& watched_at();
  void publish(ServiceDescription description);
  void write(const Own& mine);
  void leave(const Guid& provider);
  void withdraw(const Guid& provider);
  void tick();
  void write_again(const Own& mine);
  std::set<Guid> take_contradicted();
  void arm();
};

}  // namespace skein::brokerless_discovery
