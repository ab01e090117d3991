#pragma once

#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <utility>

#include "brokerless_discovery/broker.hpp"
#include "described_processes.hpp"
#include "renewals.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::brokerless_discovery {

/// Binds the table to the port. What others tell comes in on the vendor's thread and on the
/// watch's (broker_reading.cpp), what this peer tells leaves from whoever provides and from
/// `control` (broker_writing.cpp).
struct Broker::State : std::enable_shared_from_this<State> {
  struct Own {
    ServiceDescription description;
    Bytes message;
  };

  State(dds::Participant& participant_, Clock& clock_, Executor& control_, ProcessWatch& watch,
        Options options_)
      : participant(participant_),
        clock(clock_),
        control(control_),
        options(std::move(options_)),
        observers(control, itself),
        table(clock, observers, asker),
        processes(watch, table, participant.guid(), itself) {}

  dds::Participant& participant;
  Clock& clock;
  Executor& control;
  const Options options;
  const std::string asker = options.system + "/" + options.entity;
  std::weak_ptr<void> itself;  // for tasks, which reach the parts only through it
  Observers observers;
  LockedTable table;
  DescribedProcesses processes;

  std::array<std::atomic<std::uint64_t>, kRefusals> refused{};  // by Refusal
  std::atomic<bool> told_unheard{false};  // of a writer that no reader here hears

  std::mutex writing;  // guards what follows; taken before the table's lock
  std::map<Guid, Own> own;
  std::map<std::string, std::unique_ptr<dds::Writer>> writers;  // by owner; "" for public services
  Instant last_tick{};
  TimerId tick_timer = 0;
  bool closed = false;
  std::unique_ptr<dds::Reader> reader;

  Renewals renewals{options.lease, clock.now()};
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

  // ---- what this peer tells
  void publish(ServiceDescription description);
  void write(const Own& mine);
  void leave(const Guid& provider);
  void withdraw(const Guid& provider);
  void tick();
  void write_again(const Own& mine);
  void arm();
};

}  // namespace skein::brokerless_discovery
