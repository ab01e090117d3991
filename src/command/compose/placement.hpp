#pragma once

#include <map>
#include <string>

#include "command/designer/layout.hpp"
#include "design_state.idl.hpp"

namespace skein::command::compose {

/// Places the boxes of a mission that is composed. A box that was removed and comes back, as by an
/// undo, stands at its old place. Not thread-safe.
class Placement {
 public:
  using Places = std::map<std::string, designer::Place>;

  explicit Placement(Places places);

  /// Gives all entities of the design their places.
  void arrange(DesignState& design);
  /// Keeps the places of entities that `now` has under another name than `before`.
  void follow_names(const DesignState& before, const DesignState& now);

  void move(const std::string& entity, designer::Place to) { layout_.move(entity, to); }
  /// The same of an entity that arrange() has not seen yet.
  void place(const std::string& entity, designer::Place at) { layout_.place(entity, at); }
  /// All are placed anew by the next arrange().
  void forget();

  /// Those of removed boxes included.
  const Places& places() const noexcept { return places_; }
  /// The reason if boxes stand in rows; else empty.
  const std::string& failure() const noexcept { return layout_.failure(); }

 private:
  designer::Layout layout_;
  Places places_;
};

}  // namespace skein::command::compose
