#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "finding_list.hpp"
#include "profile/finding.hpp"

namespace skein::profile {

/// Lines and columns of a text, found in a time that does not grow with the length of its lines.
class TextPositions {
 public:
  /// `text` must outlive this object.
  explicit TextPositions(std::string_view text);
  /// Both count from 1; columns count characters.
  std::pair<int, int> line_and_column(std::size_t offset) const;

 private:
  std::size_t characters_before(std::size_t offset) const;

  std::string_view text_;
  std::vector<std::size_t> line_starts_{0};
  std::vector<std::size_t> characters_before_;  // at every so many bytes
};

/// Well-formed XML that remembers where everything stood.
class XmlDocument {
 public:
  /// Parses `text`. Throws DescriptionError with the place where it stops being plain XML.
  XmlDocument(std::string_view text, std::string file);
  XmlDocument(const XmlDocument&) = delete;
  XmlDocument& operator=(const XmlDocument&) = delete;

  pugi::xml_node root() const { return tree_.document_element(); }
  /// The place of a name or a value of the tree, which lies inside of the parsed buffer.
  SourcePosition position_of(const char* place) const;

 private:
  void demand_one_root() const;

  std::string file_;
  std::vector<char> buffer_;  // parsed in place: the tree points into it
  std::string original_;      // the parser writes into buffer_
  TextPositions positions_;   // of original_
  pugi::xml_document tree_;
};

/// An XML attribute with its place.
struct XmlAttribute {
  std::string value;
  SourcePosition where;
};

/// An element that is read strictly: what the reader does not ask for is a finding.
class XmlElement {
 public:
  XmlElement(pugi::xml_node node, const XmlDocument& document, FindingList& findings)
      : node_(node), document_(&document), findings_(&findings) {}

  std::string_view name() const { return node_.name(); }
  SourcePosition where() const;
  /// All text directly inside, trimmed.
  std::string text() const;

  /// The attribute, if it is there.
  std::optional<XmlAttribute> maybe_attribute(const char* attribute_name) const;
  /// The attribute's value; a finding and empty text if it is missing or empty.
  XmlAttribute attribute(const char* attribute_name) const;

  /// The child elements in their order. More of them than kMaxItems are a finding and left out:
  /// what is compared with each other later must not be many.
  std::vector<XmlElement> children() const;
  /// Those of one name.
  std::vector<XmlElement> children(std::string_view child_name) const;
  /// The only one of that name, if there is one; a second is a finding.
  std::optional<XmlElement> maybe_child(std::string_view child_name) const;

  /// Findings for attributes and children that the notation does not have here, attributes given
  /// twice, and text where only elements belong.
  void allow(const std::vector<std::string_view>& attributes,
             const std::vector<std::string_view>& child_names, bool text_allowed = false) const;

  FindingList& findings() const { return *findings_; }

 private:
  static constexpr std::size_t kMaxItems = 256;

  void allow_attributes(const std::vector<std::string_view>& names) const;
  void allow_children(const std::vector<std::string_view>& names) const;

  pugi::xml_node node_;
  const XmlDocument* document_;
  FindingList* findings_;
};

}  // namespace skein::profile
