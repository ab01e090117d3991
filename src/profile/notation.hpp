#pragma once

#include <string_view>
#include <vector>

#include "xml_node.hpp"

namespace skein::profile {

/// What may stand in an element. mission_profiles/schema says the same to editors; a test compares
/// them.
struct Notation {
  std::string_view name;
  std::vector<std::string_view> attributes;
  std::vector<Notation> children;
  bool text = false;

  const Notation* find_child(std::string_view child_name) const;  ///< Or null.
};

const Notation& mission_notation();
/// Of a file that a profile includes.
const Notation& part_notation();
const Notation& component_notation();
const Notation& dictionary_notation();

/// `<include>`, which is gone from a profile when mission_notation() is demanded of it.
const Notation& include_notation();

/// The attributes of the mission, and of a group, that each peer has unless it says otherwise.
const std::vector<std::string_view>& mission_defaults();
const std::vector<std::string_view>& group_defaults();

/// Findings for attributes and elements, at any depth, that the notation does not have there,
/// attributes that are given twice, and text where only elements belong. The name of the outermost
/// element is not looked at.
void demand_notation(const XmlNode& node, const Notation& notation, FindingList& findings);

}  // namespace skein::profile
