#include "idl/types/growing_members.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace skein::idl {
namespace {

void add_growing(const TypeSupport& type, std::set<const TypeSupport*>& seen,
                 std::vector<GrowingMember>& found) {
  if (!seen.insert(&type).second) return;
  found.insert(found.end(), type.description.growing.begin(), type.description.growing.end());
  for (const auto used : type.description.uses) add_growing(used(), seen, found);
}

}  // namespace

std::vector<GrowingMember> growing_members(const TypeSupport& type) {
  std::set<const TypeSupport*> seen;
  std::vector<GrowingMember> found;
  add_growing(type, seen, found);
  std::ranges::sort(found, {}, [](const GrowingMember& member) {
    return std::tuple(member.type, member.member);
  });
  return found;
}

}  // namespace skein::idl
