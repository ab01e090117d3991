#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "recording/mcap/reader.hpp"
#include "skein/clock.hpp"

namespace skein {
class Entity;
}

namespace skein::recording {

struct PlayerOptions {
  std::vector<std::string> topics{};  ///< By name; empty: all topics of entities.
  double rate = 1;                    ///< So many times as fast as it was recorded.
};

/// Publishes what a recording has of topics again: the same bytes, in the recorded order and pace,
/// in the recorded systems, with the QoS that their publishers had; who looks at the entity finds
/// these topics. Not thread-safe.
class Player {
 public:
  /// `entity` and `recording` outlive it. Throws InvalidArgument for a topic that is not recorded,
  /// with the most similar name, and if there is none that can be published.
  Player(Entity& entity, const Reader& recording, PlayerOptions options);
  ~Player();
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// The topics, for people.
  std::vector<std::string> topics() const;
  /// Who hears them now, of all topics together.
  std::size_t subscribers() const;

  /// Publishes all of it. `pause` is called before each value and waits as long as it is told,
  /// which may be nothing, and while the last values are not acknowledged; true from it ends the
  /// replay. Returns how many values were published.
  std::uint64_t play(const std::function<bool(Duration)>& pause);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skein::recording
