#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>

#include "skein/error.hpp"
#include "skein/guid.hpp"

namespace skein::discovery {
struct ServiceDescription;
}

/// What the Service Broker takes from others (rules R23, R25 and R26).
namespace skein::brokerless_discovery {

/// Why a description or a withdrawal was not believed.
enum class Refusal {
  Malformed,  ///< It cannot be read, or a name in it is none.
  Forged,     ///< It speaks of another participant's provider or process.
  Oversized,  ///< It is larger, or holds more, than a description may.
  NoRoom      ///< Its participant, or all together, have as many as there may be.
};
inline constexpr std::size_t kRefusals = 4;

struct Refused : InvalidArgument {
  Refused(Refusal why_, const std::string& text) : InvalidArgument(text), why(why_) {}
  Refusal why;
};

/// Whether `provider` belongs to the participant that `writer` is part of.
inline bool speaks_for(const Guid& writer, const Guid& provider) {
  return writer.participant() == provider.participant();
}

/// What may stand in a partition's name on every vendor, and in a topic.
bool is_name(const std::string& text);

/// The largest message that a description may be, and the most that it may hold of a kind.
inline constexpr std::size_t kMaxDescriptionBytes = 64u << 10;
inline constexpr std::size_t kMaxBases = 64;
inline constexpr std::size_t kMaxOperations = 1024;
inline constexpr std::size_t kMaxGrowing = 1024;  // members of types that may grow
inline constexpr std::size_t kMaxAttributes = 256;

/// Throws Refused where no participant may describe a service so, or where this one may not.
void check_description(const discovery::ServiceDescription& description, const Guid& participant);

/// What a description takes in memory, roughly: with its place under each of its names.
std::size_t weight_of(const discovery::ServiceDescription& description);

/// How much each participant has put into a bounded table. Not thread-safe.
class Room {
 public:
  static constexpr std::size_t kEntriesOfOne = 1024;
  static constexpr std::size_t kEntriesOfAll = 16u << 10;
  static constexpr std::size_t kBytesOfOne = 8u << 20;
  static constexpr std::size_t kBytesOfAll = 64u << 20;

  /// False where the participant, or all together, would exceed what they may.
  bool take(const Guid& participant, std::size_t bytes);
  void give_back(const Guid& participant, std::size_t bytes);

 private:
  struct Taken {
    std::size_t entries = 0;
    std::size_t bytes = 0;
  };

  std::unordered_map<Guid, Taken> participants_;
  Taken all_;
};

/// What each provider tells of itself on a topic of its own. Not thread-safe.
template <class Report>
class Reports {
 public:
  /// Keeps a report that came as `bytes` bytes. False where `writer` speaks of another's provider,
  /// or where there is no room.
  bool put(const Guid& provider, const Guid& writer, Report report, std::size_t bytes) {
    if (!erase(provider, writer) || !room_.take(provider.participant(), bytes)) return false;
    reports_[provider] = {std::move(report), writer, bytes};
    return true;
  }

  /// False where `writer` speaks of another's provider.
  bool erase(const Guid& provider, const Guid& writer) {
    if (!speaks_for(writer, provider)) return false;
    if (const auto node = reports_.extract(provider)) {
      room_.give_back(provider.participant(), node.mapped().bytes);
    }
    return true;
  }

  void writer_gone(const Guid& writer) {
    std::erase_if(reports_, [&](const auto& entry) {
      if (entry.second.writer != writer) return false;
      room_.give_back(entry.first.participant(), entry.second.bytes);
      return true;
    });
  }

  /// Null where it told nothing.
  const Report* find(const Guid& provider) const {
    const auto found = reports_.find(provider);
    return found == reports_.end() ? nullptr : &found->second.report;
  }

  template <class Visit>
  void for_each(Visit visit) const {
    for (const auto& [provider, told] : reports_) visit(told.report);
  }

 private:
  struct Told {
    Report report;
    Guid writer;
    std::size_t bytes = 0;
  };

  std::unordered_map<Guid, Told> reports_;
  Room room_;
};

}  // namespace skein::brokerless_discovery
