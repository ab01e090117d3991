#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>

/// What tells one version of a type that may grow from another: see GrowingMember.
namespace skein {

/// A member of which two versions differ: where both know it, it is another one; where one side
/// does not, it must be understood. Null on the side that does not know it.
template <class Here, class There>
struct Difference {
  const Here* here = nullptr;
  const There* there = nullptr;
};

/// The first difference of two ranges of GrowingMember or the like, each sorted by type and member;
/// nothing where the two versions understand each other.
template <class HereRange, class ThereRange>
auto find_difference(const HereRange& ours, const ThereRange& theirs) {
  using Here = typename HereRange::value_type;
  using There = typename ThereRange::value_type;
  using Found = std::optional<Difference<Here, There>>;
  const auto key = [](const auto& member) { return std::tie(member.type, member.member); };
  const auto knows_type = [](const auto& members, std::uint32_t type) {
    return std::ranges::any_of(members, [&](const auto& member) { return member.type == type; });
  };
  auto here = ours.begin();
  auto there = theirs.begin();
  while (here != ours.end() || there != theirs.end()) {
    const bool known_here =
        here != ours.end() && (there == theirs.end() || key(*here) <= key(*there));
    const bool known_there =
        there != theirs.end() && (here == ours.end() || key(*there) <= key(*here));
    if (known_here && known_there) {
      if (here->digest != there->digest) return Found({&*here, &*there});
    } else if (known_here && here->required && knows_type(theirs, here->type)) {
      return Found({&*here, nullptr});
    } else if (known_there && there->required && knows_type(ours, there->type)) {
      return Found({nullptr, &*there});
    }
    if (known_here) ++here;
    if (known_there) ++there;
  }
  return Found();
}

/// `digits` hexadecimal digits, as signatures and digests are shown.
inline std::string hexadecimal(std::uint64_t number, int digits) {
  std::string text;
  for (; digits > 0; --digits, number >>= 4) text.insert(0, 1, "0123456789abcdef"[number & 15]);
  return text;
}

}  // namespace skein
