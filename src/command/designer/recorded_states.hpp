#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "layout.hpp"
#include "recording/mcap/reader.hpp"

namespace skein::command::designer {

/// The channel of a recording that has a DomainState, as JSON, for each second.
inline constexpr const char* kStates = "skein/state";

/// The states of a recording that `skein record` has made. Thread-safe.
class RecordedStates {
 public:
  /// Throws InvalidArgument for a file that is no recording, or has no states.
  explicit RecordedStates(const std::string& file);

  /// When there are states, in order: `{"times": [...]}` in nanoseconds since 1970, as texts, since
  /// they are too large for the numbers of a page.
  const std::shared_ptr<const std::string>& times() const noexcept { return times_text_; }

  /// The last state at or before that time, with places; the first state, if there is none.
  std::shared_ptr<const std::string> at(std::uint64_t time) const;

  /// Damage of the file, in words.
  const std::vector<std::string>& problems() const { return reader_.problems(); }

 private:
  DomainState read(std::uint64_t time) const;
  void place_all();

  recording::Reader reader_;
  std::vector<std::uint64_t> times_;
  std::shared_ptr<const std::string> times_text_;
  mutable std::mutex mutex_;  // of the layout
  mutable Layout layout_;
};

}  // namespace skein::command::designer
