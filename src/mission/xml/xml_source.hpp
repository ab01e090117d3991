#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace skein::profile {

/// An attribute, and the bytes of the file that it takes.
struct SourceAttribute {
  std::string name;
  std::string value;            ///< As a reader sees it, without references.
  std::size_t begin = 0;        ///< Of the name.
  std::size_t value_begin = 0;  ///< Behind the first quote.
  std::size_t value_end = 0;    ///< The second quote.
};

/// An element, and the bytes of the file that it takes.
struct SourceElement {
  std::string name;
  std::optional<std::size_t> parent;  ///< Its number.
  std::vector<SourceAttribute> attributes;
  std::size_t begin = 0;      ///< The `<`.
  std::size_t start_end = 0;  ///< Behind its start tag.
  std::size_t end_begin = 0;  ///< Its end tag; `end` for one that has none: `<a/>`.
  std::size_t end = 0;        ///< Behind all of it.

  const SourceAttribute* find_attribute(std::string_view attribute_name) const;  ///< Or null.
};

/// Puts bytes in place of others.
struct Splice {
  std::size_t at = 0;
  std::size_t removed = 0;
  std::string inserted;
};

std::string spliced(std::string_view text, const Splice& splice);

/// The smallest splice that makes one text of the other.
Splice difference(std::string_view before, std::string_view after);

/// The splice that makes `before` the text that somebody has typed into a field of a page, which
/// turns all line ends into line feeds: the line ends of all that is unchanged stay.
Splice typed_difference(std::string_view before, std::string_view typed);

/// Well-formed XML as a person has written it, to change it here and there and leave the rest as it
/// is, byte for byte. Elements have numbers in the order of their start tags; the outermost has 0.
/// A plain value.
class XmlSource {
 public:
  /// Throws DescriptionError as parse_xml() does.
  XmlSource(std::string text, const std::string& file);

  const std::string& text() const noexcept { return text_; }
  const std::vector<SourceElement>& elements() const noexcept { return elements_; }

  /// The innermost element at a place as SourcePosition has it, if there is one.
  std::optional<std::size_t> element_at(int line, int column) const;

  /// Gives the attribute that value; takes it away without one. Throws InvalidArgument for
  /// characters that XML cannot hold, here and below, and std::out_of_range for other numbers.
  Splice with_attribute(std::size_t element, const std::string& name,
                        const std::optional<std::string>& value) const;

  using Attributes = std::vector<std::pair<std::string, std::string>>;
  /// Adds an element behind the last of its name, or else the last of all, indented as they are.
  Splice with_child(std::size_t parent, const std::string& name,
                    const Attributes& attributes) const;

  /// Takes an element away, with its line, if nothing else stands there. Throws InvalidArgument
  /// for the outermost.
  Splice without(std::size_t element) const;

 private:
  bool begins_line(std::size_t place) const;
  std::string indent_at(std::size_t place) const;
  std::string child_indent(std::size_t parent) const;
  std::size_t behind_comment(std::size_t place) const;

  std::string text_;
  std::string line_break_;
  std::vector<SourceElement> elements_;
};

}  // namespace skein::profile
