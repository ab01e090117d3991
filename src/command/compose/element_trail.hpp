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
  /// The text of that version, `before`, was changed by the splice; null: it was no XML.
  void add(std::uint64_t version, const profile::XmlSource* before, const profile::Splice& change);

  /// The number in `now`, the present text, of an element of that earlier version; nothing: it is
  /// gone, or the version is not known.
  std::optional<std::size_t> find(std::size_t element, std::uint64_t version,
                                  const profile::XmlSource& now) const;

 private:
  struct Step {
    std::uint64_t version;
    std::vector<std::size_t> begins;
    profile::Splice change;
  };
  std::deque<Step> steps_;
};

}  // namespace skein::command::compose
