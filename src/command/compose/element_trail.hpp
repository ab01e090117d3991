#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "mission/xml/xml_source.hpp"

namespace skein::command::compose {

/// Finds elements by the numbers that they had in an earlier version of the text, so that an edit
/// means its element although others came first. Knows the last 100 versions. A plain value.
class ElementTrail {
 public:
  /// An Edit changes elements as it says. Of any other change, as between two texts, the splice
  /// does not tell which of two alike elements has stayed.
  enum class Kind { Edit, Other };

  /// The text of that version, `before`, was changed by the splice; null: it was no XML.
  void add(std::uint64_t version, const profile::XmlSource* before, const profile::Splice& change,
           Kind kind);

  /// The number in `now`, the present text, of an element of that earlier version; nothing: it is
  /// gone, may be another one, or the version is not known.
  std::optional<std::size_t> find(std::size_t element, std::uint64_t version,
                                  const profile::XmlSource& now) const;

 private:
  struct Element {
    std::size_t begin;
    std::size_t end;
  };
  struct Step {
    std::uint64_t version;
    std::vector<Element> elements;
    profile::Splice change;
    Kind kind;
  };
  static std::optional<std::size_t> place_after(const Step& step, std::size_t begin);

  std::deque<Step> steps_;
};

}  // namespace skein::command::compose
