#include "description_limits.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "skein/error.hpp"

namespace skein::idl {
namespace {

constexpr std::size_t kMostTypes = 1024;
constexpr std::ptrdiff_t kMostColons = 2 * 31;
constexpr std::size_t kMostNested = 16;

void check_name(const std::string& name) {
  if (std::ranges::count(name, ':') <= kMostColons) return;
  throw InvalidArgument("a described type's name has too many parts: " + name.substr(0, 80) + "…");
}

std::size_t depth_of(const types::Type& type) {
  std::size_t deepest = 0;
  for (const types::Type& each : type.elements) deepest = std::max(deepest, 1 + depth_of(each));
  return deepest;
}

void check_depth(const types::Type& type, const std::string& in) {
  if (depth_of(type) <= kMostNested) return;
  throw InvalidArgument("the description of '" + in + "' has a type within a type, more than " +
                        std::to_string(kMostNested) + " deep");
}

}  // namespace

void check_limits(const types::TypeSystem& described) {
  const std::size_t count = described.declarations.size() + described.interfaces.size();
  if (count > kMostTypes) {
    throw InvalidArgument("a description of " + std::to_string(count) +
                          " types is not read: more than " + std::to_string(kMostTypes));
  }
  for (const types::Declaration& each : described.declarations) {
    check_name(each.name);
    for (const types::Type& type : each.discriminator) check_depth(type, each.name);
    for (const types::Member& member : each.members) check_depth(member.type, each.name);
  }
  for (const types::Interface& each : described.interfaces) {
    check_name(each.name);
    for (const types::Operation& operation : each.operations) {
      for (const types::Type& type : operation.result) check_depth(type, each.name);
      for (const types::Parameter& parameter : operation.parameters) {
        check_depth(parameter.type, each.name);
      }
    }
  }
}

}  // namespace skein::idl
