#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "recording/mcap/writer.hpp"
#include "skein/clock.hpp"

namespace skein {
class Entity;
}

namespace skein::recording {

struct RecorderOptions {
  std::vector<std::string> topics{};  ///< By name; empty: all that entities have.
  bool introspection = true;          ///< Calls, with their values, and decisions of Heads.
  WriterOptions writer{};
  /// Once it says so, nobody is waited for any more; asked by look() and close() while they wait.
  std::function<bool()> gives_up{};
};

/// Records a mission while it runs: the values of topics as they travel, calls with their arguments
/// and results, and decisions. README.md says which channels the file has. Thread-safe.
class Recorder {
 public:
  /// `entity` outlives it. Throws as Writer().
  Recorder(Entity& entity, const std::string& path, RecorderOptions options);
  /// As close(), but only logs what that would throw.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Looks for topics that have come, and records them from now on; waits at most `patience` for
  /// entities to answer. To be repeated. Returns what is new, for people.
  std::vector<std::string> look(Duration patience);

  /// Adds what somebody else has seen, as JSON: a message on a channel of that name.
  void note(const std::string& topic, const std::string& json);

  /// What was written and dropped so far. The entities' own drops are in it by channel.
  WriterStatistics statistics() const;

  /// Throws as Writer::close().
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skein::recording
