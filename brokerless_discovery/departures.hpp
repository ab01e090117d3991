#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "brokerless_discovery/table.hpp"
#include "skein/clock.hpp"

namespace skein::brokerless_discovery {

/// A service that was there, and has gone.
struct Absence {
  std::string service;
  std::string entity;
  Departure how;
  Instant since;
  std::uint32_t times;  ///< How often it has gone.
};

/// `'AStar' died with its process 0.2 s ago (3 times by now) and is not back`.
std::string in_words(const Absence& absence, Instant now);

/// The managed services of one entity that have gone, until they are back. Not thread-safe.
class Departures {
 public:
  /// The oldest are forgotten first: their names come from the network.
  static constexpr std::size_t kMost = 64;

  /// Notes what has become of the services of `owner`.
  void note(const Table::Changes& changes, std::string_view owner, Instant now);

  std::vector<Absence> of(std::string_view service) const;

 private:
  struct Known {
    Absence absence;
    bool back = false;
  };

  Known& known(const ServiceDescription& description);

  std::deque<Known> known_;
};

}  // namespace skein::brokerless_discovery
