#pragma once

#include <string>
#include <vector>

#include "mission/xml/xml_node.hpp"

namespace skein::command::compose {

/// A difference between two missions.
struct Difference {
  enum class Kind { New, Gone, Changed };

  Kind kind = Kind::Changed;
  std::string entity;  ///< `system/entity` in which it is; empty: in none.
  bool whole = false;  ///< All of the entity is new or gone.
  std::string text;    ///< In words.
};

/// As files say it: parts and variables are not looked into. Elements are the same if they have the
/// same name, or else the same component, file or place.
std::vector<Difference> differences(const profile::XmlNode& before, const profile::XmlNode& now);

}  // namespace skein::command::compose
