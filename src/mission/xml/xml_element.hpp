#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "xml_node.hpp"

namespace skein::profile {

/// An element as its reader sees it: what is missing or there twice is a finding. Whether
/// everything in it is known, notation.hpp says.
class XmlElement {
 public:
  /// Both must outlive this object.
  XmlElement(const XmlNode& node, FindingList& findings) : node_(&node), findings_(&findings) {}

  const std::string& name() const noexcept { return node_->name; }
  const SourcePosition& where() const noexcept { return node_->where; }
  /// All text directly inside, trimmed.
  const std::string& text() const noexcept { return node_->text; }

  /// Whether it is there, readable or not.
  bool has_attribute(std::string_view attribute_name) const {
    return node_->find_attribute(attribute_name) != nullptr;
  }
  /// The attribute, if it is there and readable.
  std::optional<XmlAttribute> maybe_attribute(std::string_view attribute_name) const;
  /// The attribute; a finding and empty text if it is missing or empty.
  XmlAttribute attribute(std::string_view attribute_name) const;

  /// The child elements of one name in their order.
  std::vector<XmlElement> children(std::string_view child_name) const;
  /// All of them.
  std::vector<XmlElement> children() const;
  /// The only one of that name, if there is one; a second is a finding.
  std::optional<XmlElement> maybe_child(std::string_view child_name) const;

  FindingList& findings() const { return *findings_; }

 private:
  const XmlNode* node_;
  FindingList* findings_;
};

}  // namespace skein::profile
