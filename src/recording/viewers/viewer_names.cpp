#include "recording/viewers/viewer_names.hpp"

#include <algorithm>

#include "idl/types/scoped_name.hpp"

namespace skein::recording {
namespace {

/// Of modules and types: viewers' parsers read no underscore at its beginning.
std::string part_of_type(const std::string& part) {
  std::string name = viewer_member(part);
  if (!name.starts_with('_')) return name;
  const auto start = std::min(name.find_first_not_of('_'), name.size() - 1);
  return (std::isdigit(static_cast<unsigned char>(name[start])) != 0 ? "x" : "") +
         name.substr(start) + "_";
}

}  // namespace

std::string viewer_member(const std::string& name) {
  return name == "byte" ? "_byte" : idl::escaped(name);
}

const std::string& ViewerNames::of_type(const types::Declaration& declaration) {
  const auto found = names_.find(declaration.name);
  if (found != names_.end()) return found->second;
  std::string name;
  std::string rest = declaration.name;
  for (std::uint32_t module = 0; !rest.empty(); ++module) {
    const std::string part = idl::first_parts(rest, 1);
    rest.erase(0, std::min(rest.size(), part.size() + 2));
    if (!name.empty()) name += module <= declaration.modules ? "::" : "_";
    name += part_of_type(part);
  }
  return names_[declaration.name] = unique(std::move(name));
}

std::string ViewerNames::of_helper(const std::string& name) {
  return unique("recorded::" + name + std::to_string(++helpers_[name]));
}

std::string ViewerNames::of_enumerator(const std::string& enumeration,
                                       const std::string& name) const {
  std::string text = viewer_member(name);
  while (taken_.contains(idl::inside(idl::scope_of(enumeration), text))) text += "_";
  return text;
}

std::string ViewerNames::unique(std::string name) {
  while (!taken_.insert(name).second) name += "_";
  return name;
}

}  // namespace skein::recording
