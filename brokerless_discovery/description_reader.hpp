#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "dds/port/port.hpp"
#include "described_processes.hpp"
#include "renewals.hpp"
#include "skein/executor.hpp"

namespace skein::brokerless_discovery {

/// Puts others' descriptions of their services into the table. A new reader asks everybody for all
/// descriptions again (R17, R26). Its own lock is never taken by a listener. Thread-safe.
class DescriptionReader {
 public:
  /// The reader's task on `control` does nothing once `owner` has gone.
  DescriptionReader(dds::Participant& participant, Clock& clock, Executor& control,
                    LockedTable& table, DescribedProcesses& processes, std::string asker,
                    std::chrono::milliseconds lease, const std::weak_ptr<void>& owner)
      : participant_(participant),
        clock_(clock),
        control_(control),
        table_(table),
        processes_(processes),
        asker_(std::move(asker)),
        lease_(lease),
        owner_(owner),
        renewals_(lease, clock.now()) {}

  void open();
  /// Ends the reader. No listener runs after that.
  void close();
  /// Asks for all descriptions again if something has found no room, or if it is time.
  void renew_if_due();

  std::uint64_t refused(Refusal why) const { return refused_[static_cast<std::size_t>(why)]; }

 private:
  std::unique_ptr<dds::Reader> make_reader();
  void on_sample(const dds::Sample& sample);
  static ServiceDescription read(const dds::Sample& sample);
  void refuse(Refusal why, const Guid& writer, const std::string& text);
  void tell_unheard(const dds::Incompatibility& why);
  void tell_other_wire(const ServiceDescription& description);
  void on_writer(const Guid& writer, bool matched);
  void renew_if_returned();
  void renew();

  dds::Participant& participant_;
  Clock& clock_;
  Executor& control_;
  LockedTable& table_;
  DescribedProcesses& processes_;
  const std::string asker_;
  const std::chrono::milliseconds lease_;
  const std::weak_ptr<void>& owner_;
  Renewals renewals_;
  std::array<std::atomic<std::uint64_t>, kRefusals> refused_{};  // by Refusal
  std::atomic<bool> told_unheard_{false};  // of a writer that no reader here hears
  std::atomic<bool> told_other_wire_{false};
  std::mutex mutex_;
  bool closed_ = false;
  std::unique_ptr<dds::Reader> reader_;
};

}  // namespace skein::brokerless_discovery
