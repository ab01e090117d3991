#include "brokerless_discovery/attribute_index.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "skein/discovery.idl.hpp"

namespace skein::brokerless_discovery {
namespace {

// Above this share of the attribute_index, putting the few in order costs more than looking at all.
constexpr std::size_t kNarrow = 8;

bool in_order(const Entry* left, const Entry* right) {
  const auto& a = *left->description;
  const auto& b = *right->description;
  return std::tie(a.entity, a.provider) < std::tie(b.entity, b.provider);
}

}  // namespace

bool AttributeIndex::before(const Value& left, const Value& right) {
  return std::tuple(left.kind, left.number, left.text,
                    reinterpret_cast<std::uintptr_t>(left.entry)) <
         std::tuple(right.kind, right.number, right.text,
                    reinterpret_cast<std::uintptr_t>(right.entry));
}

// What is equal as a number is equal, however it is written.
AttributeIndex::Value AttributeIndex::value_of(std::string_view text, const Entry* entry) {
  const Quantity quantity = quantity_of(text);
  const bool is_text = quantity.kind == Quantity::Kind::Text;
  return {quantity.kind, quantity.value, is_text ? text : std::string_view(), entry};
}

template <class Use>
void AttributeIndex::each_attribute(const Entry& entry, Use use) {
  for (const auto& attribute : entry.description->attributes) {
    if (find_attribute(*entry.description, attribute.name) != &attribute.value) continue;
    use(attribute.name, value_of(attribute.value, &entry));
  }
}

void AttributeIndex::add(const Entry& entry) {
  entries_.insert(std::upper_bound(entries_.begin(), entries_.end(), &entry, in_order), &entry);
  each_attribute(entry, [&](const std::string& name, const Value& value) {
    Column& column = columns_[name];
    column.insert(std::upper_bound(column.begin(), column.end(), value, before), value);
  });
}

void AttributeIndex::remove(const Entry& entry) {
  entries_.erase(std::lower_bound(entries_.begin(), entries_.end(), &entry, in_order));
  each_attribute(entry, [&](const std::string& name, const Value& value) {
    const auto column = columns_.find(name);
    column->second.erase(
        std::lower_bound(column->second.begin(), column->second.end(), value, before));
    if (column->second.empty()) columns_.erase(column);
  });
}

bool AttributeIndex::contains(const Entry& entry) const {
  return std::binary_search(entries_.begin(), entries_.end(), &entry, in_order);
}

AttributeIndex::Range AttributeIndex::range(const Constraint& constraint) const {
  const auto found = columns_.find(constraint.attribute);
  if (found == columns_.end()) return {};
  const Column& column = found->second;
  const Value wanted = value_of(constraint.value, nullptr);
  if (constraint.relation == Relation::NotEqual) return column;
  const auto [first, last] =
      std::equal_range(column.begin(), column.end(), wanted, [](const Value& a, const Value& b) {
        return std::tie(a.kind, a.number, a.text) < std::tie(b.kind, b.number, b.text);
      });
  const auto [begin, end] =
      std::equal_range(column.begin(), column.end(), wanted,
                       [](const Value& a, const Value& b) { return a.kind < b.kind; });
  if (constraint.relation == Relation::AtMost) return Range(begin, last);
  if (constraint.relation == Relation::AtLeast) return Range(first, end);
  return Range(first, last);
}

std::span<const Entry* const> AttributeIndex::candidates(const std::vector<Constraint>& constraints,
                                                         std::vector<const Entry*>& room) const {
  if (constraints.empty()) return entries_;
  Range narrowest = range(constraints.front());
  for (std::size_t i = 1; i < constraints.size(); ++i) {
    const Range other = range(constraints[i]);
    if (other.size() < narrowest.size()) narrowest = other;
  }
  if (narrowest.size() > entries_.size() / kNarrow) return entries_;
  room.reserve(narrowest.size());
  for (const Value& value : narrowest) room.push_back(value.entry);
  std::sort(room.begin(), room.end(), in_order);
  return room;
}

}  // namespace skein::brokerless_discovery
