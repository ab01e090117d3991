#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "brokerless_discovery/broker.hpp"

namespace skein::brokerless_discovery {

/// How busy the providers are, each by its own word: requests that wait or run there. It is
/// measured, and so travels on a status topic of its own, not in the description: at most once in
/// kInterval, and only when it has changed. A peer whose services are not called does nothing and
/// tells nothing. Thread-safe.
class LoadBoard {
 public:
  static constexpr std::chrono::milliseconds kInterval{100};

  /// The references outlive the board; `control` measures and writes.
  LoadBoard(dds::Participant& participant, Clock& clock, Executor& control);
  ~LoadBoard();

  /// Tells everybody what `measure` gives now, and whenever notifier() was called, until the
  /// registration goes; `measure` does not run then any more. It must not block.
  Broker::Registration tell(const Guid& provider, std::function<std::size_t()> measure);

  /// To be called when some load may have changed, which then is measured within kInterval; on any
  /// thread, a vendor's too, and even after the board has gone. Cheap.
  std::function<void()> notifier() const;

  /// What the provider told last; 0 where it told nothing.
  std::size_t load_of(const Guid& provider) const;

  /// Loads that were not believed, since the start: malformed, of another participant's provider
  /// (R23), or without room (R26).
  std::uint64_t refused() const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace skein::brokerless_discovery
