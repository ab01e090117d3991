#pragma once

#include <string_view>
#include <vector>

#include "mission/xml/xml_node.hpp"

namespace skein::profile {

using Names = std::vector<std::string_view>;

/// The attributes and elements that may stand in an element, from mission_profiles/schema, which
/// is built in.
struct Notation {
  std::string_view name;
  Names attributes;
  std::vector<Notation> children;
  bool text = false;

  const Notation* find_child(std::string_view child_name) const;  ///< Or null.
};

const Notation& mission_notation();
/// All of it as an XML schema.
std::string_view mission_schema();
/// Of a file that a profile includes.
const Notation& part_notation();
const Notation& component_notation();
const Notation& dictionary_notation();

/// Attributes that one reader reads, or that a peer has from elsewhere: groups of the schema.
inline constexpr const char* kMissionDefaults = "DefaultsOfPeers";  ///< Unless it says otherwise.
inline constexpr const char* kGroupDefaults = "GroupAttributes";    ///< The same, of its group.
inline constexpr const char* kProcessAttributes = "ProcessAttributes";
inline constexpr const char* kThreadAttributes = "ThreadAttributes";
inline constexpr const char* kHeadAttributes = "HeadAttributes";
const Names& attribute_group(const char* name);

/// Findings for attributes and elements, at any depth, that the notation does not have there,
/// attributes that are given twice, and text where only elements belong. The name of the outermost
/// element is not looked at.
void demand_notation(const XmlNode& node, const Notation& notation, FindingList& findings);

}  // namespace skein::profile
