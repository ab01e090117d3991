#include "placement.hpp"

#include <algorithm>

namespace skein::command::compose {
namespace {

/// While two entities have one name, it says nothing of either.
bool is_unique(const std::string& entity, const DesignState& design) {
  return std::ranges::count_if(design.parts, [&](const PartState& part) {
           return part.csp.empty() && part.entity == entity;
         }) == 1;
}

}  // namespace

Placement::Placement(Places places) : places_(std::move(places)) { layout_.restore(places_); }

void Placement::arrange(DesignState& design) {
  for (const auto& entity : design.entities) {
    const auto known = places_.find(entity.name);
    if (known != places_.end() && !layout_.places().contains(entity.name))
      layout_.place(entity.name, known->second);
  }
  layout_.arrange(design.entities, design.links);
  for (const auto& [entity, place] : layout_.places()) places_[entity] = place;
}

void Placement::follow_names(const DesignState& before, const DesignState& now) {
  if (before.parts.size() != now.parts.size()) return;
  for (std::size_t i = 0; i < before.parts.size(); ++i) {
    const PartState& old = before.parts[i];
    const PartState& part = now.parts[i];
    if (old.element != part.element || !old.csp.empty() || old.entity == part.entity) continue;
    if (!is_unique(old.entity, before) || !is_unique(part.entity, now)) continue;
    layout_.rename(old.entity, part.entity);
    places_.erase(old.entity);
    places_.erase(part.entity);
  }
}

void Placement::forget() {
  layout_.forget();
  places_.clear();
}

}  // namespace skein::command::compose
