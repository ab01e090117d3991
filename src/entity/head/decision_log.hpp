#pragma once

#include <cstdint>
#include <fstream>
#include <mutex>
#include <string>

#include "skein/introspection.idl.hpp"

namespace skein::entity {

/// The file in which a Head writes its decisions, one a line, as JSON. When it is full, `x.jsonl`
/// becomes `x.1.jsonl`, in place of an earlier one. Thread-safe.
class DecisionLog {
 public:
  static constexpr std::uintmax_t kFull = std::uintmax_t{64} << 20;

  /// Appends to the file `path` for the Head of `entity`; without a path it writes nothing. `full`
  /// is in bytes. Throws InvalidArgument if it cannot be written.
  DecisionLog(std::string entity, std::string path, std::uintmax_t full = kFull);

  bool on() const noexcept { return !path_.empty(); }

  /// A decision that cannot be written is lost: the program's log tells of the first one, and how
  /// many they were once the file can be written again.
  void write(const introspection::Decision& decision);

 private:
  void make_room(std::size_t size);

  const std::string entity_;
  const std::string path_;
  const std::uintmax_t full_;
  std::mutex mutex_;
  std::ofstream file_;
  std::uint64_t lost_ = 0;  // since one was written last
};

}  // namespace skein::entity
