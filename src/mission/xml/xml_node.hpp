#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "finding_list.hpp"
#include "mission/xml/finding.hpp"

namespace skein::profile {

/// More children, or attributes, of one element are a finding and left out: what is compared with
/// each other later must not be many.
constexpr std::size_t kMaxItems = 256;

/// More elements and attributes, of a file or of a whole profile, are a finding and left out.
constexpr std::size_t kMaxNodes = 20'000;

/// An XML attribute with its place.
struct XmlAttribute {
  std::string name;
  std::string value;  ///< Without white space around it.
  SourcePosition where;
  bool inherited = false;   ///< Stands at an element around this one.
  bool unreadable = false;  ///< There is a finding of it already: nothing more is to be said.
  /// The place of the variable that is its whole value.
  std::optional<SourcePosition> given_by{};
};

/// An element as it stands in a file. A plain value.
struct XmlNode {
  std::string name;
  SourcePosition where;
  std::vector<XmlAttribute> attributes;
  std::vector<XmlNode> children;
  std::string text;  ///< All text directly inside, trimmed.

  const XmlAttribute* find_attribute(std::string_view attribute_name) const;  ///< Or null.
};

/// The outermost element of `text`, without the attributes that tell an editor where the schema is.
/// Throws DescriptionError with the place where the text stops being plain XML; what is too large
/// or nested too deep is a finding and left out.
XmlNode parse_xml(std::string_view text, const std::string& file, FindingList& findings);

/// Elements and attributes in it, itself included.
std::size_t size_of(const XmlNode& node);

}  // namespace skein::profile
