#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "designer_state.idl.hpp"

namespace skein::command::designer {

struct Place {
  double x = 0;  ///< Of the box's left upper corner, in pixels.
  double y = 0;
};

/// A box that is to be placed.
struct Box {
  std::string name;
  std::string system;  ///< Those of one system stand together.
  double width = 0;
  double height = 0;
};

/// Boxes and the lines between them, by their indices.
struct Drawing {
  std::vector<Box> boxes;
  std::vector<std::pair<std::size_t, std::size_t>> lines;
};

/// One place for each box: of each system by Graphviz, boxes without a line in rows below; systems
/// side by side. Throws as run_dot().
std::vector<Place> places_by_graphviz(const Drawing& drawing);

/// The places of the boxes of a page. A box keeps its place as long as it is shown, and newcomers
/// come near those that they speak to; only if a third are newcomers, or twice as many lines are
/// known, and nobody has moved anything, all are placed anew. Not thread-safe.
class Layout {
 public:
  using Placer = std::function<std::vector<Place>(const Drawing& drawing)>;

  /// If `place` throws Unavailable, boxes stand in rows, and failure() tells why.
  explicit Layout(Placer place = places_by_graphviz) : place_(std::move(place)) {}

  /// Gives all entities size and place.
  void arrange(std::vector<EntityState>& entities, const std::vector<Link>& links);

  /// As a user moves a box.
  void move(const std::string& entity, Place to);
  /// The same of one that is to come.
  void place(const std::string& entity, Place at);
  /// Its place stays.
  void rename(const std::string& entity, const std::string& to);
  /// All are placed anew the next time.
  void forget();

  const std::string& failure() const noexcept { return failure_; }

  /// Of all boxes that were arranged, to put them there again.
  const std::map<std::string, Place>& places() const noexcept { return places_; }
  void restore(std::map<std::string, Place> places);

 private:
  std::vector<Place> placed(const Drawing& drawing);
  void settle(const Drawing& drawing, const std::vector<Place>& proposed);

  const Placer place_;
  std::map<std::string, Place> places_;
  std::size_t lines_ = 0;  // that were known when all were placed
  bool moved_ = false;
  std::string failure_;
};

}  // namespace skein::command::designer
