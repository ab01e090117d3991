#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/constraint.hpp"
#include "skein/guid.hpp"

namespace skein::brokerless_discovery {

/// What the Table keeps of one description.
struct Entry {
  std::shared_ptr<const discovery::ServiceDescription> description;
  Guid writer;  ///< Nil for this peer's own.
  bool suspect = false;
  std::size_t weight = 0;  ///< What it takes of its participant's room.
  bool leaving = false;
  bool other_wire = false;
};

/// The Table's entries of one name: in the order of R8, and by the values of their attributes, so
/// that a look-up pays for those whom its narrowest constraint leaves, and not for all. Not
/// thread-safe.
class AttributeIndex {
 public:
  /// `entry` stays where it is, and what it describes unchanged, until it is removed.
  void add(const Entry& entry);
  void remove(const Entry& entry);

  bool contains(const Entry& entry) const;
  bool empty() const noexcept { return entries_.empty(); }

  /// Whoever meets the constraints is among these, in the order of R8; others may be, too. They lie
  /// in the attribute_index or in `room`.
  std::span<const Entry* const> candidates(const std::vector<Constraint>& constraints,
                                           std::vector<const Entry*>& room) const;

 private:
  /// A declared value: the text as it lies in the description, and the number where it is one.
  struct Value {
    Quantity::Kind kind;
    double number;
    std::string_view text;
    const Entry* entry;
  };
  using Column = std::vector<Value>;  // numbers, lengths of time, and texts, each in their order
  using Range = std::span<const Value>;

  static bool before(const Value& left, const Value& right);
  static Value value_of(std::string_view text, const Entry* entry);
  Range range(const Constraint& constraint) const;
  template <class Use>
  void each_attribute(const Entry& entry, Use use);

  std::vector<const Entry*> entries_;
  std::map<std::string, Column, std::less<>> columns_;  // by attribute
};

}  // namespace skein::brokerless_discovery
