#pragma once

#include <cstdint>
#include <fstream>
#include <mutex>
#include <string>

#include "skein/introspection.idl.hpp"

namespace skein::entity {

/// The file in which a Head writes its decisions, one a line, as JSON. Thread-safe.
class DecisionLog {
 public:
  /// Appends to the file `path` for the Head of `entity`; without a path it writes nothing. Throws
  /// InvalidArgument if it cannot be written.
  DecisionLog(std::string entity, std::string path);

  bool on() const noexcept { return !path_.empty(); }

  /// A decision that cannot be written is lost: the program's log tells of the first one, and how
  /// many they were once the file can be written again.
  void write(const introspection::Decision& decision);

 private:
  const std::string entity_;
  const std::string path_;
  std::mutex mutex_;
  std::ofstream file_;
  std::uint64_t lost_ = 0;  // since one was written last
};

}  // namespace skein::entity
