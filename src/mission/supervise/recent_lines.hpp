#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "skein/mission_status.idl.hpp"

namespace skein::launch {

/// The latest lines of a mission, for clients of its launcher. Not thread-safe.
class RecentLines {
 public:
  static constexpr std::size_t kKept = 300;
  static constexpr std::size_t kLongest = 512;  ///< Octets; of a longer one the beginning is kept.

  /// `time`: nanoseconds since 1970.
  void add(std::uint64_t time, const std::string& process, const std::string& system, bool printed,
           std::string_view text);

  /// MissionLines as JSON.
  std::string json() const;

 private:
  std::uint64_t count_ = 0;
  std::deque<MissionLine> lines_;
};

}  // namespace skein::launch
