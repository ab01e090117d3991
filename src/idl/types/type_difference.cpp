#include "idl/types/type_difference.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "core/printable.hpp"
#include "idl/types/flags.hpp"
#include "idl/types/type_words.hpp"

namespace skein::idl {
namespace {

using namespace types;
using Found = std::optional<TypeDifference>;

constexpr std::size_t kDeepest = 64;       // of types within types that are compared
constexpr std::size_t kLongestText = 512;  // of what is told

const Declaration* find_declaration(const TypeSystem& types, const std::string& name) {
  const auto found = std::ranges::find(types.declarations, name, &Declaration::name);
  return found == types.declarations.end() ? nullptr : &*found;
}

/// Own and inherited, each once.
void add_operations(const TypeSystem& types, const std::string& name, std::set<std::string>& seen,
                    std::vector<const Operation*>& operations) {
  const auto found = std::ranges::find(types.interfaces, name, &Interface::name);
  if (found == types.interfaces.end() || !seen.insert(name).second) return;
  for (const Operation& operation : found->operations) operations.push_back(&operation);
  for (const std::string& base : found->bases) add_operations(types, base, seen, operations);
}

std::vector<const Operation*> operations_of(const TypeSystem& types, const std::string& interface) {
  std::set<std::string> seen;
  std::vector<const Operation*> operations;
  add_operations(types, interface, seen, operations);
  return operations;
}

bool must_be_understood(const Member& member) {
  return has(member.flags, MemberFlags::key) || has(member.flags, MemberFlags::must_understand);
}

/// A place in one of the types: `parameter 'from'` as a whole, `from.points[]` within.
struct Place {
  std::string whole;
  std::string within;

  Place member(const std::string& name) const {
    const std::string path = within + "." + name;
    return {path, path};
  }
  Place element(const char* which) const { return {within + which, within + which}; }
  /// What has a name there and no value, as an enumerator.
  std::string named(const std::string& what, const std::string& name) const {
    return whole + ": " + what + " '" + name + "'";
  }
};

using PlaceOf = std::function<std::string(const std::string& name)>;

template <class Items>
std::optional<std::size_t> position_of(const Items& items, const std::string& name) {
  const auto found = std::ranges::find(items, name, [](const auto& item) { return item.name; });
  if (found == items.end()) return std::nullopt;
  return static_cast<std::size_t>(found - items.begin());
}

/// Of what counts by its place and its name: the first that is missing, moved or renamed.
template <class Items>
Found difference_of_lists(const Items& here, const Items& there, const PlaceOf& place) {
  for (std::size_t i = 0; i < std::max(here.size(), there.size()); ++i) {
    if (i >= there.size()) return TypeDifference{place(here[i].name), "there", ""};
    if (i >= here.size()) return TypeDifference{place(there[i].name), "", "there"};
    const std::string& mine = here[i].name;
    const std::string& other = there[i].name;
    if (mine == other) continue;
    const auto moved = position_of(there, mine);
    const auto came = position_of(here, other);
    if (moved && came) {
      return TypeDifference{place(mine), "number " + std::to_string(i + 1),
                            "number " + std::to_string(*moved + 1)};
    }
    if (moved) return TypeDifference{place(other), "", "there"};
    if (came) return TypeDifference{place(mine), "there", ""};
    return TypeDifference{place(mine), "called that", "called '" + other + "'"};
  }
  return std::nullopt;
}

std::string labels_of(const Member& member) {
  std::string text;
  for (const std::int64_t label : member.labels)
    text += (text.empty() ? "of case " : ", ") + std::to_string(label);
  if (has(member.flags, MemberFlags::by_default))
    text += text.empty() ? "the default" : ", default";
  return text;
}

std::string counted_bits(std::uint8_t bits) { return "of " + std::to_string(bits) + " bits"; }

/// Compares the types of two versions. Each pair of declared types is looked at once.
class Comparison {
 public:
  Comparison(const TypeSystem& here, const TypeSystem& there) : here_(here), there_(there) {}

  Found operation(const Operation& here, const Operation& there);
  Found declaration(const Place& place, const Declaration& here, const Declaration& there);

 private:
  Found result(const Operation& here, const Operation& there);
  Found parameters(const Operation& here, const Operation& there);
  Found exceptions(const Operation& here, const Operation& there);
  Found exception(const std::string& name);
  Found type(const Place& place, const Type& here, const Type& there);
  Found declared(const Place& place, const std::string& here, const std::string& there);
  Found contents(const Place& place, const Declaration& here, const Declaration& there);
  Found members(const Place& place, const Declaration& here, const Declaration& there);
  Found cases(const Place& place, const Declaration& here, const Declaration& there);
  Found growing_members(const Place& place, const Declaration& here, const Declaration& there);
  Found growing_cases(const Place& place, const Declaration& here, const Declaration& there);
  static Found values(const Place& place, const Declaration& here, const Declaration& there);
  static Found fields(const Place& place, const Declaration& here, const Declaration& there);
  Found same_key(const Place& place, const Member& here, const Member& there);

  const TypeSystem& here_;
  const TypeSystem& there_;
  std::set<std::pair<std::string, std::string>> compared_;
  std::size_t depth_ = 0;
};

Found Comparison::operation(const Operation& here, const Operation& there) {
  Found found;
  const bool one_way = has(here.flags, OperationFlags::one_way);
  if (one_way != has(there.flags, OperationFlags::one_way)) {
    found = {"the call", one_way ? "oneway" : "answered", one_way ? "answered" : "oneway"};
  }
  if (!found) found = result(here, there);
  if (!found) found = parameters(here, there);
  if (!found) found = exceptions(here, there);
  if (found) found->place = "operation '" + here.name + "': " + found->place;
  return found;
}

Found Comparison::result(const Operation& here, const Operation& there) {
  if (here.result.empty() && there.result.empty()) return std::nullopt;
  const Place place{"the result", "result"};
  if (!here.result.empty() && !there.result.empty()) {
    return type(place, here.result[0], there.result[0]);
  }
  const auto told = [](const Operation& operation) {
    return operation.result.empty() ? std::string("void") : in_words(operation.result[0]);
  };
  return TypeDifference{place.whole, told(here), told(there)};
}

Found Comparison::parameters(const Operation& here, const Operation& there) {
  const auto place = [](const std::string& name) { return "parameter '" + name + "'"; };
  if (auto found = difference_of_lists(here.parameters, there.parameters, place)) return found;
  constexpr const char* kDirections[] = {"in", "out", "inout"};
  for (std::size_t i = 0; i < here.parameters.size(); ++i) {
    const Parameter& mine = here.parameters[i];
    const Parameter& other = there.parameters[i];
    if (mine.direction != other.direction) {
      return TypeDifference{place(mine.name), kDirections[static_cast<int>(mine.direction)],
                            kDirections[static_cast<int>(other.direction)]};
    }
    if (auto found = type({place(mine.name), mine.name}, mine.type, other.type)) return found;
  }
  return std::nullopt;
}

Found Comparison::exceptions(const Operation& here, const Operation& there) {
  const auto lacks = [](const Operation& operation, const std::string& name) {
    return std::ranges::find(operation.raises, name) == operation.raises.end();
  };
  for (const std::string& name : here.raises) {
    if (lacks(there, name)) return TypeDifference{"exception " + name, "raised", "not raised"};
    if (auto found = exception(name)) return found;
  }
  for (const std::string& name : there.raises) {
    if (lacks(here, name)) return TypeDifference{"exception " + name, "not raised", "raised"};
  }
  return std::nullopt;
}

Found Comparison::exception(const std::string& name) {
  return declared({"exception " + name, name}, name, name);
}

Found Comparison::type(const Place& place, const Type& here, const Type& there) {
  const TypeDifference differing{place.whole, in_words(here), in_words(there)};
  if (here.kind != there.kind || here.bound != there.bound ||
      here.elements.size() != there.elements.size() ||
      (here.kind == Kind::Reference && here.name != there.name)) {
    return differing;
  }
  if (here.kind == Kind::Declared) return declared(place, here.name, there.name);
  for (std::size_t i = 0; i < here.elements.size(); ++i) {
    const bool key = here.kind == Kind::Map && i == 0;
    const Place inner =
        here.kind == Kind::OptionalMember ? place : place.element(key ? "[key]" : "[]");
    if (auto found = type(inner, here.elements[i], there.elements[i])) return found;
  }
  return std::nullopt;
}

Found Comparison::declared(const Place& place, const std::string& here, const std::string& there) {
  const Declaration* const mine = find_declaration(here_, here);
  const Declaration* const other = find_declaration(there_, there);
  if (!mine || !other || depth_ == kDeepest) return std::nullopt;
  if (!compared_.emplace(here, there).second) return std::nullopt;
  ++depth_;
  auto found = declaration(place, *mine, *other);
  --depth_;
  return found;
}

Found Comparison::declaration(const Place& place, const Declaration& here,
                              const Declaration& there) {
  const bool grows = here.extensibility != Extensibility::Final;
  if (here.kind != there.kind || here.extensibility != there.extensibility ||
      (grows && here.name != there.name)) {
    return TypeDifference{place.whole, in_words(here), in_words(there)};
  }
  return contents(place, here, there);
}

Found Comparison::contents(const Place& place, const Declaration& here, const Declaration& there) {
  const bool grows = here.extensibility != Extensibility::Final;
  switch (here.kind) {
    case DeclarationKind::Enumeration:
    case DeclarationKind::Bitmask:
      return values(place, here, there);
    case DeclarationKind::Bitset:
      return fields(place, here, there);
    case DeclarationKind::Union:
      if (!here.discriminator.empty() && !there.discriminator.empty()) {
        const Place inner = place.member("switch");
        if (auto found = type(inner, here.discriminator[0], there.discriminator[0])) return found;
      }
      return grows ? growing_cases(place, here, there) : cases(place, here, there);
    default:
      return grows ? growing_members(place, here, there) : members(place, here, there);
  }
}

Found Comparison::members(const Place& place, const Declaration& here, const Declaration& there) {
  const auto place_of = [&](const std::string& name) { return place.member(name).whole; };
  if (auto found = difference_of_lists(here.members, there.members, place_of)) return found;
  for (std::size_t i = 0; i < here.members.size(); ++i) {
    const Member& mine = here.members[i];
    if (auto found = type(place.member(mine.name), mine.type, there.members[i].type)) return found;
  }
  return std::nullopt;
}

Found Comparison::cases(const Place& place, const Declaration& here, const Declaration& there) {
  if (auto found = members(place, here, there)) return found;
  for (std::size_t i = 0; i < here.members.size(); ++i) {
    const std::string mine = labels_of(here.members[i]);
    const std::string other = labels_of(there.members[i]);
    if (mine != other) return TypeDifference{place.member(here.members[i].name).whole, mine, other};
  }
  return std::nullopt;
}

/// Of two members that are one and the same to a reader.
Found Comparison::same_key(const Place& place, const Member& here, const Member& there) {
  const Place member = place.member(here.name);
  if (here.name != there.name)
    return TypeDifference{member.whole, "called that", "called '" + there.name + "'"};
  return type(member, here.type, there.type);
}

Found Comparison::growing_members(const Place& place, const Declaration& here,
                                  const Declaration& there) {
  const bool by_id = here.extensibility == Extensibility::Mutable;
  const auto find = [&](const Declaration& declaration, const Declaration& of, std::size_t i) {
    if (!by_id) return i < declaration.members.size() ? &declaration.members[i] : nullptr;
    const auto found = std::ranges::find(declaration.members, of.members[i].id, &Member::id);
    return found == declaration.members.end() ? nullptr : &*found;
  };
  for (std::size_t i = 0; i < here.members.size(); ++i) {
    const Member& mine = here.members[i];
    const Member* const other = find(there, here, i);
    if (other) {
      if (auto found = same_key(place, mine, *other)) return found;
    } else if (must_be_understood(mine)) {
      return TypeDifference{place.member(mine.name).whole, "a member that must be understood", ""};
    }
  }
  for (std::size_t i = 0; i < there.members.size(); ++i) {
    const Member& other = there.members[i];
    if (!find(here, there, i) && must_be_understood(other))
      return TypeDifference{place.member(other.name).whole, "", "a member that must be understood"};
  }
  return std::nullopt;
}

Found Comparison::growing_cases(const Place& place, const Declaration& here,
                                const Declaration& there) {
  const auto selects = [](const Member& member, std::int64_t label) {
    return std::ranges::find(member.labels, label) != member.labels.end();
  };
  for (const Member& mine : here.members) {
    for (const Member& other : there.members) {
      const bool both_default =
          has(mine.flags, MemberFlags::by_default) && has(other.flags, MemberFlags::by_default);
      const bool share = std::ranges::any_of(
          mine.labels, [&](std::int64_t label) { return selects(other, label); });
      if (!both_default && !share) continue;
      if (auto found = same_key(place, mine, other)) return found;
    }
  }
  return std::nullopt;
}

Found Comparison::values(const Place& place, const Declaration& here, const Declaration& there) {
  const bool enumeration = here.kind == DeclarationKind::Enumeration;
  const std::string what = (enumeration ? "enumerator " : "bit ") + here.name + "::";
  const auto place_of = [&](const std::string& name) { return place.whole + ": " + what + name; };
  if (auto found = difference_of_lists(here.values, there.values, place_of)) return found;
  for (std::size_t i = 0; i < here.values.size(); ++i) {
    const auto mine = here.values[i].value;
    const auto other = there.values[i].value;
    if (mine != other) {
      return TypeDifference{place_of(here.values[i].name), std::to_string(mine),
                            std::to_string(other)};
    }
  }
  if (here.bits == there.bits) return std::nullopt;
  return TypeDifference{place.whole, counted_bits(here.bits), counted_bits(there.bits)};
}

Found Comparison::fields(const Place& place, const Declaration& here, const Declaration& there) {
  const auto place_of = [&](const std::string& name) { return place.member(name).whole; };
  if (auto found = difference_of_lists(here.fields, there.fields, place_of)) return found;
  for (std::size_t i = 0; i < here.fields.size(); ++i) {
    const BitField& mine = here.fields[i];
    const BitField& other = there.fields[i];
    if (mine.width != other.width)
      return TypeDifference{place_of(mine.name), counted_bits(mine.width),
                            counted_bits(other.width)};
    if (mine.kind != other.kind)
      return TypeDifference{place_of(mine.name), in_words(mine.kind), in_words(other.kind)};
  }
  if (here.bits == there.bits) return std::nullopt;
  return TypeDifference{place.whole, counted_bits(here.bits), counted_bits(there.bits)};
}

}  // namespace

std::string in_words(const TypeDifference& difference, const std::string& here,
                     const std::string& there) {
  const auto& [place, mine, other] = difference;
  if (other.empty()) return printable(place + " is missing " + there, kLongestText);
  if (mine.empty()) return printable(place + " is missing " + here, kLongestText);
  return printable(place + " is " + mine + " " + here + " and " + other + " " + there,
                   kLongestText);
}

Found difference_of_interfaces(const std::string& name, const TypeSystem& here,
                               const TypeSystem& there) try {
  const auto offered = operations_of(there, name);
  if (offered.empty()) return std::nullopt;
  Comparison comparison(here, there);
  for (const Operation* mine : operations_of(here, name)) {
    const auto other =
        std::ranges::find(offered, mine->name, [](const auto* each) { return each->name; });
    if (other != offered.end()) {
      if (auto found = comparison.operation(*mine, **other)) return found;
    } else if (!has(mine->flags, OperationFlags::optional)) {
      return TypeDifference{"operation '" + mine->name + "'", "there", ""};
    }
  }
  return std::nullopt;
} catch (const std::out_of_range&) {  // a description lacks what its kind has
  return std::nullopt;
}

Found difference_of_types(const TypeSystem& here, const TypeSystem& there) try {
  Comparison comparison(here, there);
  for (const Declaration& mine : here.declarations) {
    const Declaration* const other = find_declaration(there, mine.name);
    if (!other) continue;
    if (auto found = comparison.declaration({mine.name, mine.name}, mine, *other)) return found;
  }
  return std::nullopt;
} catch (const std::out_of_range&) {  // likewise
  return std::nullopt;
}

}  // namespace skein::idl
