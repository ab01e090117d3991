#include "xml_node.hpp"

#include <algorithm>
#include <pugixml.hpp>

#include "words.hpp"
#include "xml_markup.hpp"
#include "xml_text.hpp"

namespace skein::profile {
namespace {

constexpr int kMaxDepth = 16;

bool is_text(const pugi::xml_node& node) {
  return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
}

/// For editors; a validator of schemas allows them everywhere.
bool names_schema(std::string_view attribute) {
  return attribute == "xmlns:xsi" || attribute == "xsi:noNamespaceSchemaLocation";
}

/// Well-formed XML that remembers where everything stood.
class Document {
 public:
  Document(std::string_view text, const std::string& file, FindingList& findings)
      : file_(file), findings_(findings), buffer_(text.begin(), text.end()), original_(text) {
    demand_plain_xml_text(original_, file_);
    if (trimmed(text).empty()) {
      throw DescriptionError({Finding{Severity::Error, {file_, 0, 0}, "is empty", {}}});
    }
    const auto result = tree_.load_buffer_inplace(buffer_.data(), buffer_.size(),
                                                  pugi::parse_default, pugi::encoding_utf8);
    if (!result) {
      if (auto mistake = find_markup_error(original_, file_)) throw DescriptionError({*mistake});
      throw DescriptionError({Finding{Severity::Error,
                                      position_of(buffer_.data() + result.offset),
                                      std::string("malformed XML: ") + result.description(),
                                      {}}});
    }
    demand_one_root();
  }
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  XmlNode root() {
    auto root = node_of(tree_.document_element(), 1);
    std::erase_if(root.attributes,
                  [](const XmlAttribute& attribute) { return names_schema(attribute.name); });
    return root;
  }

 private:
  void demand_one_root() {
    const auto second = tree_.document_element().next_sibling();
    if (!second) return;
    throw DescriptionError({Finding{Severity::Error, position_of(second.name() - 1),
                                    "a second element at the top", "a file has one"}});
  }

  /// The place of a name or a value of the tree, which lies inside of the parsed buffer. Goes on
  /// from the place before, so that a whole file costs one pass, however long its lines are.
  SourcePosition position_of(const char* place) {
    const auto offset = static_cast<std::size_t>(place - buffer_.data());
    if (place < buffer_.data() || offset >= buffer_.size()) return {file_, 0, 0};
    if (offset < counted_) counted_ = 0, position_ = {file_, 1, 1};
    for (; counted_ < offset; ++counted_) {
      const char c = original_[counted_];
      if (c == '\n') {
        position_ = {file_, position_.line + 1, 1};
      } else if ((c & 0xC0) != 0x80) {
        ++position_.column;
      }
    }
    return position_;
  }

  XmlNode node_of(const pugi::xml_node& element, int depth) {
    XmlNode node{element.name(), position_of(element.name() - 1), {}, {}, {}};
    ++nodes_;
    for (const auto attribute : element.attributes()) {
      if (node.attributes.size() == kMaxItems) {
        refuse(node, node.where, "has more than " + std::to_string(kMaxItems) + " attributes");
        break;
      }
      ++nodes_;
      node.attributes.push_back({attribute.name(), std::string(trimmed(attribute.value())),
                                 position_of(attribute.name())});
    }
    for (const auto child : element.children()) {
      if (is_text(child)) node.text += child.value();
      if (child.type() == pugi::node_element && !add_child(node, child, depth)) break;
    }
    node.text = trimmed(node.text);
    return node;
  }

  /// False where no more are read.
  bool add_child(XmlNode& node, const pugi::xml_node& child, int depth) {
    const auto where = position_of(child.name() - 1);
    if (node.children.size() == kMaxItems) {
      return refuse(node, where, "holds more than " + std::to_string(kMaxItems) + " elements");
    }
    if (nodes_ >= kMaxNodes) {
      findings_.error({file_, 0, 0},
                      "holds more than " + std::to_string(kMaxNodes) + " elements and attributes",
                      "split the file");
      return false;
    }
    if (depth == kMaxDepth) {
      return refuse(node, where, "is nested more than " + std::to_string(kMaxDepth) + " deep");
    }
    node.children.push_back(node_of(child, depth + 1));
    return true;
  }

  bool refuse(const XmlNode& node, const SourcePosition& where, const std::string& problem) {
    findings_.error(where, "<" + shortened(node.name) + "> " + problem, "split the file");
    return false;
  }

  const std::string& file_;
  FindingList& findings_;
  std::vector<char> buffer_;  // parsed in place: the tree points into it
  std::string original_;      // the parser writes into buffer_
  std::size_t counted_ = 0;   // bytes of it before position_
  SourcePosition position_{file_, 1, 1};
  pugi::xml_document tree_;
  std::size_t nodes_ = 0;
};

}  // namespace

const XmlAttribute* XmlNode::find_attribute(std::string_view attribute_name) const {
  const auto found =
      std::find_if(attributes.begin(), attributes.end(),
                   [&](const XmlAttribute& attribute) { return attribute.name == attribute_name; });
  return found == attributes.end() ? nullptr : &*found;
}

XmlNode parse_xml(std::string_view text, const std::string& file, FindingList& findings) {
  return Document(text, file, findings).root();
}

std::size_t size_of(const XmlNode& node) {
  std::size_t size = 1 + node.attributes.size();
  for (const auto& child : node.children) size += size_of(child);
  return size;
}

}  // namespace skein::profile
