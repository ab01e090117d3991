#include "xml_source.hpp"

#include <algorithm>
#include <pugixml.hpp>

#include "skein/error.hpp"
#include "xml_node.hpp"

namespace skein::profile {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::size_t kLineLength = 120;
/// Deeper than what any mission may hold.
constexpr int kDeepest = 100;

/// Goes through a parsed tree in the order of the text.
class SpanReader {
 public:
  SpanReader(const std::string& text, const std::string& file)
      : text_(text), file_(file), buffer_(text.begin(), text.end()) {
    tree_.load_buffer_inplace(buffer_.data(), buffer_.size(),
                              pugi::parse_default | pugi::parse_comments | pugi::parse_pi,
                              pugi::encoding_utf8);
  }

  std::vector<SourceElement> run() {
    read(tree_.document_element(), std::nullopt);
    return std::move(elements_);
  }

 private:
  std::size_t place_of(const char* in_buffer) const {
    return static_cast<std::size_t>(in_buffer - buffer_.data());
  }

  std::size_t behind(std::string_view end, std::size_t from) const {
    return text_.find(end, from) + end.size();
  }

  void read(const pugi::xml_node& node, std::optional<std::size_t> parent, int depth = 1) {
    if (depth > kDeepest) {
      throw DescriptionError(
          {{Severity::Error, {file_, 0, 0}, "is nested too deep", "split the file"}});
    }
    const std::size_t number = elements_.size();
    elements_.push_back(started(node, parent));
    for (const auto& child : node.children()) {
      if (child.type() == pugi::node_element) read(child, number, depth + 1);
      if (child.type() == pugi::node_comment) at_ = behind("-->", place_of(child.value()));
      if (child.type() == pugi::node_cdata) at_ = behind("]]>", place_of(child.value()));
      if (child.type() == pugi::node_pi) at_ = behind("?>", place_of(child.name()));
    }
    SourceElement& element = elements_[number];
    if (text_[element.start_end - 2] != '/') {
      element.end_begin = text_.find('<', at_);
      at_ = behind(">", element.end_begin);
    }
    element.end = at_;
    if (element.end_begin == 0) element.end_begin = at_;
  }

  SourceElement started(const pugi::xml_node& node, std::optional<std::size_t> parent) {
    SourceElement element{node.name(), parent, {}, place_of(node.name()) - 1};
    std::size_t last = element.begin + 1 + element.name.size();
    for (const auto& each : node.attributes()) {
      SourceAttribute attribute{each.name(), each.value(), place_of(each.name()),
                                place_of(each.value())};
      attribute.value_end = text_.find(text_[attribute.value_begin - 1], attribute.value_begin);
      last = attribute.value_end + 1;
      element.attributes.push_back(std::move(attribute));
    }
    at_ = element.start_end = behind(">", last);
    return element;
  }

  const std::string& text_;
  const std::string& file_;
  std::vector<char> buffer_;  // parsed in place: the tree points into it
  pugi::xml_document tree_;
  std::vector<SourceElement> elements_;
  std::size_t at_ = 0;  // behind what was read
};

/// As it stands between two such quotes.
std::string escaped(const std::string& value, char quote) {
  std::string text;
  for (const char* none : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})
    if (value.find(none) != std::string::npos)
      throw InvalidArgument("a value holds U+FFFE or U+FFFF, which XML cannot hold");
  for (const char c : value) {
    if (c == '&') {
      text += "&amp;";
    } else if (c == '<') {
      text += "&lt;";
    } else if (c == quote) {
      text += quote == '"' ? "&quot;" : "&apos;";
    } else if (c == '\t' || c == '\n' || c == '\r') {
      text += "&#" + std::to_string(c) + ";";
    } else if (static_cast<unsigned char>(c) < ' ') {
      throw InvalidArgument("a value holds a control character, which XML cannot hold");
    } else {
      text += c;
    }
  }
  return text;
}

std::string tag_of(const std::string& name, const XmlSource::Attributes& attributes) {
  std::string tag = "<" + name;
  for (const auto& [attribute, value] : attributes)
    tag += " " + attribute + "=\"" + escaped(value, '"') + "\"";
  return tag + "/>";
}

/// Where its last attribute ends, or its name.
std::size_t last_end(const SourceElement& element) {
  return element.attributes.empty() ? element.begin + 1 + element.name.size()
                                    : element.attributes.back().value_end + 1;
}

}  // namespace

const SourceAttribute* SourceElement::find_attribute(std::string_view attribute_name) const {
  const auto found = std::ranges::find(attributes, attribute_name, &SourceAttribute::name);
  return found == attributes.end() ? nullptr : &*found;
}

std::string spliced(std::string_view text, const Splice& splice) {
  return std::string(text.substr(0, splice.at)) + splice.inserted +
         std::string(text.substr(splice.at + splice.removed));
}

Splice difference(std::string_view before, std::string_view after) {
  const std::size_t shorter = std::min(before.size(), after.size());
  std::size_t same = 0, tail = 0;
  while (same < shorter && before[same] == after[same]) ++same;
  while (tail < shorter - same &&
         before[before.size() - 1 - tail] == after[after.size() - 1 - tail])
    ++tail;
  return {same, before.size() - same - tail,
          std::string(after.substr(same, after.size() - same - tail))};
}

/// As a field of a page has it: with line feeds alone.
static std::string as_field(std::string_view text) {
  std::string field;
  for (std::size_t i = 0; i < text.size(); ++i) {
    field += text[i] == '\r' ? '\n' : text[i];
    if (text.substr(i).starts_with("\r\n")) ++i;
  }
  return field;
}

Splice typed_difference(std::string_view before, std::string_view typed) {
  const bool plain = before.find('\r') == std::string_view::npos;
  if (plain || typed.find('\r') != std::string_view::npos) return difference(before, typed);
  std::string fed;                 // `before` with line feeds alone
  std::vector<std::size_t> place;  // of each of its bytes in `before`
  for (std::size_t i = 0; i < before.size(); ++i) {
    place.push_back(i);
    fed += before[i] == '\r' ? '\n' : before[i];
    if (before.substr(i).starts_with("\r\n")) ++i;
  }
  place.push_back(before.size());
  const Splice change = difference(fed, typed);
  const std::string_view line_break = before.find("\r\n") == std::string_view::npos ? "\r" : "\r\n";
  Splice splice{place[change.at], place[change.at + change.removed] - place[change.at], ""};
  for (const char c : change.inserted) {
    if (c == '\n') {
      splice.inserted += line_break;
    } else {
      splice.inserted += c;
    }
  }
  // Next to a lone carriage return, another line end may become one with it.
  return as_field(spliced(before, splice)) == typed ? splice : difference(before, typed);
}

XmlSource::XmlSource(std::string text, const std::string& file) : text_(std::move(text)) {
  FindingList others_tell;
  parse_xml(text_, file, others_tell);
  elements_ = SpanReader(text_, file).run();
  line_break_ = text_.find("\r\n") == std::string::npos ? "\n" : "\r\n";
}

std::optional<std::size_t> XmlSource::element_at(int line, int column) const {
  std::size_t place = 0;
  for (int i = 1; i < line && place < text_.size(); ++i)
    place = std::min(text_.find('\n', place), text_.size() - 1) + 1;
  for (int i = 1; i < column && place < text_.size(); ++i)
    while (++place < text_.size() && (text_[place] & 0xC0) == 0x80) continue;
  std::optional<std::size_t> innermost;
  for (std::size_t i = 0; i < elements_.size(); ++i)
    if (elements_[i].begin <= place && place < elements_[i].end) innermost = i;
  return innermost;
}

Splice XmlSource::with_attribute(std::size_t number, const std::string& name,
                                 const std::optional<std::string>& value) const {
  const SourceElement& element = elements_.at(number);
  const auto& all = element.attributes;
  const auto known = std::ranges::find(all, name, &SourceAttribute::name);
  if (known == all.end()) {
    if (!value) return {};
    const std::size_t at = last_end(element);
    std::string text = name + "=\"" + escaped(*value, '"') + "\"";
    const auto column = [&](std::size_t place) { return place - (text_.rfind('\n', place) + 1); };
    const bool fits = all.empty() || column(at) + text.size() < kLineLength;
    text = (fits ? " " : line_break_ + std::string(column(all.front().begin), ' ')) + text;
    return {at, 0, std::move(text)};
  }
  if (value) {
    return {known->value_begin, known->value_end - known->value_begin,
            escaped(*value, text_[known->value_end])};
  }
  const std::size_t before = known == all.begin() ? element.begin + 1 + element.name.size()
                                                  : std::prev(known)->value_end + 1;
  return {before, known->value_end + 1 - before, ""};
}

/// Whether there are only blanks before it on its line.
bool XmlSource::begins_line(std::size_t place) const {
  const std::size_t line = text_.rfind('\n', place) + 1;
  return text_.find_first_not_of(kBlanks, line) == place;
}

/// The blanks with which its line begins, if it is the first there; else nothing.
std::string XmlSource::indent_at(std::size_t place) const {
  const std::size_t line = text_.rfind('\n', place) + 1;
  return begins_line(place) ? text_.substr(line, place - line) : "";
}

std::string XmlSource::child_indent(std::size_t parent) const {
  for (std::size_t i = elements_.size(); i-- > 0;)
    if (elements_[i].parent == parent && begins_line(elements_[i].begin))
      return indent_at(elements_[i].begin);
  const std::string own = indent_at(elements_[parent].begin);
  return own + (own.find('\t') == std::string::npos ? "  " : "\t");
}

/// A comment on the same line belongs to what stands before it.
std::size_t XmlSource::behind_comment(std::size_t place) const {
  const std::size_t next = text_.find_first_not_of(" \t", place);
  constexpr std::string_view kOpen = "<!--", kClose = "-->";
  if (next == std::string::npos || text_.compare(next, kOpen.size(), kOpen) != 0) return place;
  const std::size_t end = text_.find(kClose, next) + kClose.size();
  const bool one_line = text_.find('\n', next) >= end;
  return one_line && text_.find_first_not_of(" \t\r", end) == text_.find('\n', end) ? end : place;
}

Splice XmlSource::with_child(std::size_t number, const std::string& name,
                             const Attributes& attributes) const {
  const SourceElement& parent = elements_.at(number);
  const std::string tag = tag_of(name, attributes);
  const std::string own_line = line_break_ + indent_at(parent.begin);
  if (parent.end_begin == parent.end) {
    const std::size_t at = last_end(parent);
    return {at, parent.end - at,
            ">" + line_break_ + child_indent(number) + tag + own_line + "</" + parent.name + ">"};
  }
  for (std::size_t i = elements_.size(); i-- > number + 1;) {
    if (elements_[i].parent != number || elements_[i].name != name) continue;
    return {behind_comment(elements_[i].end), 0, line_break_ + indent_at(elements_[i].begin) + tag};
  }
  const std::size_t at = text_.find_last_not_of(kBlanks, parent.end_begin - 1) + 1;
  const bool open = text_.find('\n', at) < parent.end_begin;
  return {at, 0, line_break_ + child_indent(number) + tag + (open ? "" : own_line)};
}

Splice XmlSource::without(std::size_t number) const {
  if (number == 0) throw InvalidArgument("the outermost element cannot be removed");
  const SourceElement& element = elements_.at(number);
  const std::size_t line = text_.rfind('\n', element.begin) + 1;
  const std::size_t next = text_.find('\n', element.end);
  const bool alone = next != std::string::npos && begins_line(element.begin) &&
                     text_.find_first_not_of(kBlanks, element.end) > next;
  if (alone) return {line, next + 1 - line, ""};
  return {element.begin, element.end - element.begin, ""};
}

}  // namespace skein::profile
