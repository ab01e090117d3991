#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "recording/mcap/reader.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::recording {

/// A trace in Chrome's JSON format, which Perfetto's viewer opens, of what entities say of calls
/// and decisions: a process for each entity, a slice for each call at its caller and at its
/// provider with an arrow between them, and a slice for each decision with its attempts inside.
/// What goes on at the same time lies on tracks of its own. Times are those of each entity's clock.
/// Not thread-safe.
class PerfettoTrace {
 public:
  /// Events of one entity in the order in which they happened. A call of which the end is missing
  /// lasts until the last event; of one whose beginning is missing nothing is shown.
  void add(const introspection::CallEvent& event);
  void add(const introspection::Decision& decision);

  /// The file.
  std::string finish();

 private:
  struct Slice {
    std::uint64_t begin = 0;
    std::optional<std::uint64_t> end{};
    std::string name{};
    std::optional<std::uint64_t> flow{};  ///< The same at both ends of an arrow.
    std::map<std::string, std::string> details{};
    std::vector<Slice> inner{};
  };
  /// On which side of which call, and who says so.
  using CallKey = std::tuple<std::array<std::uint8_t, 16>, std::uint64_t, bool, std::string,
                             std::string, std::string>;
  struct Lane;
  class Writer;

  void see(std::uint64_t time) {
    first_ = std::min(first_, time);
    last_ = std::max(last_, time);
  }

  /// By entity, and then by what they show.
  std::map<std::string, std::map<std::string, std::deque<Slice>>> slices_;
  std::map<CallKey, std::deque<Slice*>> open_;
  std::map<std::uint64_t, std::uint64_t> flows_;  // when they begin
  std::uint64_t first_ = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t last_ = 0;
};

struct PerfettoExport {
  std::size_t events = 0;  ///< Of calls.
  std::size_t decisions = 0;
  std::size_t malformed = 0;  ///< Messages that could not be decoded.
};

/// Writes what a recording has on `skein/calls` and `skein/decisions`. Throws InvalidArgument where
/// it has neither, and WriteFailed if the file cannot be made or written.
PerfettoExport export_to_perfetto(const Reader& recording, const std::string& path);

}  // namespace skein::recording
