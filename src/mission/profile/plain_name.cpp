#include "plain_name.hpp"

#include <algorithm>

#include "mission/xml/words.hpp"

namespace skein::profile {
namespace {

constexpr std::size_t kLongestName = 64;

}  // namespace

bool demand_plain_name(const XmlAttribute& name, FindingList& findings) {
  const bool plain = std::all_of(name.value.begin(), name.value.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  if (plain && name.value.size() <= kLongestName) return true;
  findings.error(name.where, in_quotes(name.value) + " is no name",
                 "use letters, digits, _ and -, at most " + std::to_string(kLongestName));
  return false;
}

}  // namespace skein::profile
