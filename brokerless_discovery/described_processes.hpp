#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "brokerless_discovery/process_watch.hpp"
#include "locked_table.hpp"

namespace skein::brokerless_discovery {

/// Has the processes of this host watched that the table describes, and no others (R14, R27), and
/// lets others watch this process. Thread-safe.
class DescribedProcesses {
 public:
  /// A process's end changes the table no more once `owner` has gone.
  DescribedProcesses(ProcessWatch& watch, LockedTable& table, const Guid& participant,
                     const std::weak_ptr<void>& owner)
      : watch_(watch), table_(table), participant_(participant), owner_(owner) {}

  const std::string& host() const noexcept { return host_; }
  /// The address at which others watch this process.
  std::string own_address();
  /// Nothing is watched any more, and nobody else begins to watch this process.
  void close();

  /// Watches the process that is about to be described. Returns it for settle(), or nothing if it
  /// cannot be watched.
  std::string watch(const ServiceDescription& description);
  /// To be called after each change: descriptions come on one thread while others go on another.
  void settle(const std::string& process);
  void settle(const Table::Changes& changes);

 private:
  bool may_be_watched(const ServiceDescription& description) const;
  void watch_process(const std::string& process);

  ProcessWatch& watch_;
  LockedTable& table_;
  const Guid participant_;
  const std::weak_ptr<void>& owner_;
  const std::string host_ = ProcessWatch::host();
  std::mutex mutex_;
  std::string own_address_;
};

}  // namespace skein::brokerless_discovery
