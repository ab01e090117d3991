#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "dds/port/port.hpp"
#include "locked_table.hpp"
#include "skein/discovery.idl.hpp"

namespace skein::brokerless_discovery {

/// The descriptions of this peer's own services: each is changed here and in the table under one
/// lock, which is taken before the table's. Thread-safe.
class DescriptionWriter {
 public:
  DescriptionWriter(dds::Participant& participant, LockedTable& table, Observers& observers,
                    std::chrono::milliseconds lease)
      : participant_(participant), table_(table), observers_(observers), lease_(lease) {}

  /// Nothing is left of the service if this throws.
  void add(ServiceDescription description);
  /// Says that the service is about to leave (R28). A service that is withdrawn meanwhile stays so.
  void leave(const Guid& provider);
  void withdraw(const Guid& provider);
  /// Writes descriptions again (R17, R24): all, or those of `contradicted`.
  void write_again(bool all, const std::set<Guid>& contradicted);
  /// Forgets the descriptions and ends the writers.
  void close();

 private:
  struct Own {
    ServiceDescription description;
    Bytes message;
  };

  void put(ServiceDescription description);
  void tell(const Guid& provider);
  void write(const Own& mine);

  dds::Participant& participant_;
  LockedTable& table_;
  Observers& observers_;
  const std::chrono::milliseconds lease_;
  std::mutex mutex_;
  std::map<Guid, Own> own_;
  std::map<std::string, std::unique_ptr<dds::Writer>> writers_;  // by owner; "" for public services
};

}  // namespace skein::brokerless_discovery
