#include "xml_document.hpp"

#include <algorithm>
#include <set>

#include "words.hpp"
#include "xml_text.hpp"

namespace skein::profile {
namespace {

bool is_text(const pugi::xml_node& node) {
  return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
}

constexpr std::size_t kStride = 256;

bool starts_character(char c) { return (c & 0xC0) != 0x80; }

}  // namespace

TextPositions::TextPositions(std::string_view text) : text_(text) {
  std::size_t characters = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (at % kStride == 0) characters_before_.push_back(characters);
    if (starts_character(text[at])) ++characters;
    if (text[at] == '\n') line_starts_.push_back(at + 1);
  }
  characters_before_.push_back(characters);
}

std::size_t TextPositions::characters_before(std::size_t offset) const {
  const std::size_t step = offset / kStride;
  const auto rest = text_.substr(step * kStride, offset % kStride);
  return characters_before_[step] +
         static_cast<std::size_t>(std::count_if(rest.begin(), rest.end(), starts_character));
}

std::pair<int, int> TextPositions::line_and_column(std::size_t offset) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const std::size_t column = characters_before(offset) - characters_before(*(after - 1));
  return {static_cast<int>(after - line_starts_.begin()), static_cast<int>(column) + 1};
}

XmlDocument::XmlDocument(std::string_view text, std::string file)
    : file_(std::move(file)),
      buffer_(text.begin(), text.end()),
      original_(text),
      positions_(original_) {
  demand_plain_xml_text(original_, file_);
  if (trimmed(text).empty()) {
    throw DescriptionError({Finding{Severity::Error, {file_, 0, 0}, "is empty", {}}});
  }
  const auto result = tree_.load_buffer_inplace(buffer_.data(), buffer_.size(), pugi::parse_default,
                                                pugi::encoding_utf8);
  if (!result) {
    throw DescriptionError({Finding{Severity::Error,
                                    position_of(buffer_.data() + result.offset),
                                    std::string("malformed XML: ") + result.description(),
                                    {}}});
  }
  demand_one_root();
}

void XmlDocument::demand_one_root() const {
  const auto second = root().next_sibling();
  if (!second) return;
  throw DescriptionError({Finding{Severity::Error, position_of(second.name() - 1),
                                  "a second element at the top", "a file has one"}});
}

SourcePosition XmlDocument::position_of(const char* place) const {
  const auto offset = static_cast<std::size_t>(place - buffer_.data());
  if (place < buffer_.data() || offset >= buffer_.size()) return {file_, 0, 0};
  const auto [line, column] = positions_.line_and_column(offset);
  return {file_, line, column};
}

SourcePosition XmlElement::where() const { return document_->position_of(node_.name() - 1); }

std::string XmlElement::text() const {
  std::string text;
  for (const auto child : node_.children()) {
    if (is_text(child)) text += child.value();
  }
  return std::string(trimmed(text));
}

std::optional<XmlAttribute> XmlElement::maybe_attribute(const char* attribute_name) const {
  const auto found = node_.attribute(attribute_name);
  if (!found) return std::nullopt;
  return XmlAttribute{std::string(trimmed(found.value())), document_->position_of(found.name())};
}

XmlAttribute XmlElement::attribute(const char* attribute_name) const {
  const auto found = maybe_attribute(attribute_name);
  if (found && !found->value.empty()) return *found;
  findings_->error(
      found ? found->where : where(),
      "<" + shortened(name()) + "> " + (found ? "has an empty " : "has no ") + attribute_name,
      "write " + std::string(attribute_name) + "=\"...\"");
  return {"", found ? found->where : where()};
}

std::vector<XmlElement> XmlElement::children() const {
  std::vector<XmlElement> found;
  for (const auto child : node_.children()) {
    if (child.type() != pugi::node_element) continue;
    found.emplace_back(child, *document_, *findings_);
    if (found.size() <= kMaxItems) continue;
    findings_->error(
        found.back().where(),
        "<" + shortened(name()) + "> holds more than " + std::to_string(kMaxItems) + " elements",
        "split the file");
    found.pop_back();
    break;
  }
  return found;
}

std::vector<XmlElement> XmlElement::children(std::string_view child_name) const {
  auto found = children();
  std::erase_if(found, [&](const XmlElement& child) { return child.name() != child_name; });
  return found;
}

std::optional<XmlElement> XmlElement::maybe_child(std::string_view child_name) const {
  const auto found = children(child_name);
  for (std::size_t i = 1; i < found.size(); ++i) {
    findings_->error(found[i].where(), "a second <" + std::string(child_name) + ">",
                     "put its content into the first, at " + to_text(found[0].where()));
  }
  if (found.empty()) return std::nullopt;
  return found.front();
}

void XmlElement::allow(const std::vector<std::string_view>& attributes,
                       const std::vector<std::string_view>& child_names, bool text_allowed) const {
  allow_attributes(attributes);
  allow_children(child_names);
  if (text_allowed || text().empty()) return;
  findings_->error(where(), "<" + shortened(name()) + "> holds the text " + in_quotes(text()),
                   "it holds elements only");
}

void XmlElement::allow_attributes(const std::vector<std::string_view>& names) const {
  std::set<std::string_view> seen;
  for (const auto attribute : node_.attributes()) {
    if (findings_->full()) return;
    const std::string_view attribute_name = attribute.name();
    const auto place = document_->position_of(attribute.name());
    if (!seen.insert(attribute_name).second) {
      findings_->error(place, in_quotes(attribute_name) + " is given twice", "keep one");
    } else if (std::find(names.begin(), names.end(), attribute_name) == names.end()) {
      findings_->error(place, "<" + shortened(name()) + "> has no " + in_quotes(attribute_name),
                       remedy_for(attribute_name, names));
    }
  }
}

void XmlElement::allow_children(const std::vector<std::string_view>& names) const {
  for (const auto& child : children()) {
    if (std::find(names.begin(), names.end(), child.name()) != names.end()) continue;
    findings_->error(child.where(),
                     "<" + shortened(child.name()) + "> is unknown in <" + shortened(name()) + ">",
                     remedy_for(child.name(), names));
  }
}

}  // namespace skein::profile
