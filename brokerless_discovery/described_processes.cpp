#include "described_processes.hpp"

#include <set>

#include "skein/discovery.idl.hpp"

namespace skein::brokerless_discovery {

std::string DescribedProcesses::own_address() {
  std::lock_guard lock(mutex_);
  if (own_address_.empty()) own_address_ = watch_.open(participant_);
  return own_address_;
}

void DescribedProcesses::close() {
  watch_.unwatch(this);
  std::lock_guard lock(mutex_);
  watch_.close(own_address_);
}

std::string DescribedProcesses::watch(const ServiceDescription& description) {
  if (!may_be_watched(description)) return {};
  watch_process(description.process);
  return description.process;
}

void DescribedProcesses::settle(const std::string& process) {
  if (process.empty()) return;
  const auto known = [&] {
    return table_.look([&](const Table& table) { return table.knows_process(process); });
  };
  if (!known()) watch_.unwatch(process, this);
  if (known()) watch_process(process);
}

void DescribedProcesses::settle(const Table::Changes& changes) {
  std::set<std::string> processes;
  for (const Change& change : changes) {
    if (change.kind == Change::Kind::Removed && may_be_watched(*change.description)) {
      processes.insert(change.description->process);
    }
  }
  for (const std::string& process : processes) settle(process);
}

bool DescribedProcesses::may_be_watched(const ServiceDescription& description) const {
  return description.host == host_ && !description.process.empty();
}

void DescribedProcesses::watch_process(const std::string& process) {
  watch_.watch(process, this, [this, owner = owner_, process] {
    const auto kept = owner.lock();
    if (!kept) return;
    settle(table_.apply([&](Table& table) { return table.on_process_ended(process); }));
  });
}

}  // namespace skein::brokerless_discovery
