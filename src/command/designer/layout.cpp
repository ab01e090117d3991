#include "layout.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <sstream>

#include "command/print/graphviz.hpp"
#include "skein/error.hpp"

namespace skein::command::designer {
namespace {

constexpr double kPixelsPerInch = 72;
// As the page's style has them.
constexpr double kWidth = 208;
constexpr double kHeadHeight = 50;
constexpr double kRowHeight = 20;
constexpr double kGap = 28;
constexpr double kBetweenSystems = 90;
constexpr std::size_t kMostLines = 150;
/// A topic with more readers does not show which entities belong together.
constexpr std::size_t kFewReaders = 2;

std::string node(std::size_t box) { return "n" + std::to_string(box); }
std::string inches(double pixels) { return std::to_string(pixels / kPixelsPerInch); }

using Lines = std::vector<std::pair<std::size_t, std::size_t>>;

/// Boxes that are placed together, by their indices in the drawing.
using Boxes = std::vector<std::size_t>;

std::string dot_of(const Drawing& drawing, const Boxes& boxes, const Lines& lines,
                   const std::string& direction) {
  const bool down = direction == "TB";  // boxes are broad: there is more room below than beside
  std::string text = "digraph { rankdir=" + direction + "; nodesep=" + (down ? "1" : "0.4") +
                     "; ranksep=" + (down ? "0.7" : "0.9") +
                     "; splines=false; nslimit=5; nslimit1=5;\n"
                     "node [shape=box, fixedsize=true, label=\"\"];\n";
  for (const std::size_t i : boxes) {
    const Box& box = drawing.boxes[i];
    text += node(i) + " [width=" + inches(box.width) + ", height=" + inches(box.height) + "];\n";
  }
  for (const auto& [from, to] : lines) text += node(from) + " -> " + node(to) + ";\n";
  return text + "}\n";
}

Drawing drawing_of(const std::vector<EntityState>& entities, const std::vector<Link>& links) {
  Drawing drawing;
  std::map<std::string, std::size_t> numbers;
  for (const EntityState& entity : entities) {
    numbers[entity.name] = drawing.boxes.size();
    drawing.boxes.push_back({entity.name, entity.system, entity.width, entity.height});
  }
  std::map<std::string, std::size_t> readers;
  for (const Link& link : links) ++readers[link.name];
  std::set<std::pair<std::size_t, std::size_t>> lines;
  for (const Link& link : links) {
    if (link.kind == LinkKind::Values && readers[link.name] > kFewReaders) continue;
    const auto from = numbers.find(link.source), to = numbers.find(link.target);
    if (from != numbers.end() && to != numbers.end()) lines.emplace(from->second, to->second);
  }
  drawing.lines.assign(lines.begin(), lines.end());
  return drawing;
}

/// Places of some boxes, relative to their common corner.
struct Arrangement {
  std::map<std::size_t, Place> places;
  double width = 0;
  double height = 0;

  /// As large as it looks on a screen of 4 by 3.
  double size() const { return std::max(width / 4, height / 3); }
};

/// Adds boxes in rows below all others.
void add_rows(const Drawing& drawing, const Boxes& boxes, Arrangement& made) {
  const auto columns = std::max(
      std::size_t{5},
      static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(boxes.size()) * 0.8))));
  double y = made.height == 0 ? 0 : made.height + kGap, height = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i > 0 && i % columns == 0) {
      y += height + kGap;
      height = 0;
    }
    const double x = static_cast<double>(i % columns) * (kWidth + 3 * kGap);
    made.places[boxes[i]] = {x, y};
    made.width = std::max(made.width, x + drawing.boxes[boxes[i]].width);
    height = std::max(height, drawing.boxes[boxes[i]].height);
    made.height = y + height;
  }
}

Arrangement by_dot(const Drawing& drawing, const Boxes& boxes, const Lines& lines,
                   const std::string& direction) {
  Arrangement made;
  std::istringstream answer(run_dot("plain", dot_of(drawing, boxes, lines, direction)));
  for (std::string line; std::getline(answer, line);) {
    std::istringstream words(line);
    std::string kind, name;
    words >> kind >> name;
    double x = 0, y = 0;
    if (!(words >> x >> y)) continue;
    if (kind == "graph") {  // its name is its scale, which is 1
      made.width = x * kPixelsPerInch;
      made.height = y * kPixelsPerInch;
    } else if (kind == "node") {
      const std::size_t i = std::stoul(name.substr(1));
      const Box& box = drawing.boxes.at(i);
      made.places[i] = {std::round(x * kPixelsPerInch - box.width / 2),
                        std::round(made.height - y * kPixelsPerInch - box.height / 2)};
    }
  }
  return made;
}

/// One system. If almost all entities speak to each other, an arrangement shows nothing, and
/// Graphviz needs minutes for it.
Arrangement arranged(const Drawing& drawing, const Boxes& system) {
  const std::set<std::size_t> own(system.begin(), system.end());
  Lines lines;
  std::set<std::size_t> tied;
  for (const auto& [from, to] : drawing.lines) {
    if (!own.contains(from) || !own.contains(to)) continue;
    lines.emplace_back(from, to);
    tied.insert({from, to});
  }
  Arrangement best;
  if (lines.size() > kMostLines && lines.size() > 2 * tied.size()) tied.clear();
  if (!tied.empty()) {
    const Boxes boxes(tied.begin(), tied.end());
    best = by_dot(drawing, boxes, lines, "LR");
    if (Arrangement other = by_dot(drawing, boxes, lines, "TB"); other.size() < best.size())
      best = std::move(other);
  }
  Boxes loose;
  std::ranges::copy_if(system, std::back_inserter(loose),
                       [&](std::size_t i) { return !tied.contains(i); });
  add_rows(drawing, loose, best);
  return best;
}

/// Systems side by side, and in as many rows as make the whole as broad as a screen.
std::vector<Place> side_by_side(const std::vector<Arrangement>& systems, std::size_t boxes) {
  double area = 0;
  for (const Arrangement& system : systems)
    area += (system.width + kBetweenSystems) * (system.height + kBetweenSystems);
  const double broad = std::sqrt(area * 4 / 3);
  std::vector<Place> places(boxes);
  double x = 0, y = 0, height = 0;
  for (const Arrangement& system : systems) {
    if (x > 0 && x + system.width > broad) {
      y += height + kBetweenSystems;
      x = height = 0;
    }
    for (const auto& [box, place] : system.places) places[box] = {x + place.x, y + place.y};
    x += system.width + kBetweenSystems;
    height = std::max(height, system.height);
  }
  return places;
}

std::vector<Place> places_in_rows(const Drawing& drawing) {
  Boxes all(drawing.boxes.size());
  std::iota(all.begin(), all.end(), 0);
  Arrangement rows;
  add_rows(drawing, all, rows);
  return side_by_side({rows}, all.size());
}

bool overlap(const Box& one, Place at, const Box& other, Place there) {
  return at.x < there.x + other.width + kGap / 2 && there.x < at.x + one.width + kGap / 2 &&
         at.y < there.y + other.height + kGap / 2 && there.y < at.y + one.height + kGap / 2;
}

}  // namespace

std::vector<Place> places_by_graphviz(const Drawing& drawing) {
  std::map<std::string, Boxes> systems;
  for (std::size_t i = 0; i < drawing.boxes.size(); ++i)
    systems[drawing.boxes[i].system].push_back(i);
  std::vector<Arrangement> made;
  for (const auto& [name, boxes] : systems) made.push_back(arranged(drawing, boxes));
  return side_by_side(made, drawing.boxes.size());
}

void Layout::arrange(std::vector<EntityState>& entities, const std::vector<Link>& links) {
  for (EntityState& entity : entities) {
    entity.width = kWidth;
    const auto has_csp = [](const ServiceState& service) { return !service.csp.empty(); };
    const bool has_head = std::ranges::any_of(entity.services, has_csp);
    const auto rows = entity.services.size() + (has_head ? 1 : 0);
    entity.height = kHeadHeight + kRowHeight * static_cast<double>(rows);
  }
  const auto is_new = [&](const EntityState& entity) { return !places_.contains(entity.name); };
  const auto newcomers = static_cast<std::size_t>(std::ranges::count_if(entities, is_new));
  const Drawing drawing = drawing_of(entities, links);
  const bool knows_more = drawing.lines.size() > 3 && drawing.lines.size() >= 2 * lines_;
  if (newcomers > 0 || (knows_more && !moved_)) {
    if (!moved_ && (newcomers * 3 >= entities.size() || knows_more)) places_.clear();
    if (places_.empty()) lines_ = drawing.lines.size();
    settle(drawing, placed(drawing));
  }
  std::map<std::string, Place> kept;
  for (EntityState& entity : entities) {
    const Place place = kept[entity.name] = places_.at(entity.name);
    entity.x = place.x;
    entity.y = place.y;
  }
  places_ = std::move(kept);
}

std::vector<Place> Layout::placed(const Drawing& drawing) {
  try {
    auto places = place_(drawing);
    failure_.clear();
    return places;
  } catch (const Unavailable& error) {
    failure_ = error.what();
    return places_in_rows(drawing);
  }
}

/// Places each new box beside its neighbours as proposed, and moves it down while it covers
/// another.
void Layout::settle(const Drawing& drawing, const std::vector<Place>& proposed) {
  const std::map<std::string, Place> before = places_;
  const auto shift_of = [&](std::size_t box) {
    Place shift;
    double count = 0;
    const auto add = [&](std::size_t other) {
      const auto known = before.find(drawing.boxes[other].name);
      if (known == before.end()) return;
      shift.x += known->second.x - proposed[other].x;
      shift.y += known->second.y - proposed[other].y;
      ++count;
    };
    for (const auto& [from, to] : drawing.lines) {
      if (from == box) add(to);
      if (to == box) add(from);
    }
    return count > 0 ? Place{std::round(shift.x / count), std::round(shift.y / count)} : Place{};
  };
  const auto hit_by = [&](const Box& box, Place at) -> const Box* {
    const auto hit = std::ranges::find_if(drawing.boxes, [&](const Box& other) {
      const auto place = places_.find(other.name);
      return place != places_.end() && overlap(box, at, other, place->second);
    });
    return hit == drawing.boxes.end() ? nullptr : &*hit;
  };
  for (std::size_t i = 0; i < drawing.boxes.size(); ++i) {
    const Box& box = drawing.boxes[i];
    if (before.contains(box.name)) continue;
    Place at = proposed[i];
    if (!before.empty()) {
      const Place shift = shift_of(i);
      at = {at.x + shift.x, at.y + shift.y};
      while (const Box* hit = hit_by(box, at)) at.y = places_[hit->name].y + hit->height + kGap;
    }
    places_[box.name] = at;
  }
}

void Layout::move(const std::string& entity, Place to) {
  if (places_.contains(entity)) place(entity, to);
}

void Layout::place(const std::string& entity, Place at) {
  places_[entity] = at;
  moved_ = true;
}

void Layout::rename(const std::string& entity, const std::string& to) {
  auto place = places_.extract(entity);
  if (!place) return;
  place.key() = to;
  places_.insert(std::move(place));
}

void Layout::restore(std::map<std::string, Place> places) {
  moved_ = !places.empty();
  places_ = std::move(places);
}

void Layout::forget() {
  places_.clear();
  moved_ = false;
}

}  // namespace skein::command::designer
