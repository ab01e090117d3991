#pragma once

#include <map>
#include <set>
#include <string>

#include "skein/types.idl.hpp"

namespace skein::recording {

/// Names that viewers' parsers can read: types stand in modules alone, and nothing is called like a
/// word of their language. All different. Functions throw InvalidArgument for what is no
/// identifier.
class ViewerNames {
 public:
  /// `A::S_T` for a type `T` in the struct `S` in the module `A`; always the same.
  const std::string& of_type(const types::Declaration& declaration);
  /// A new type of ours: `recorded::Value1`.
  std::string of_helper(const std::string& name);
  /// Of an enumerator, which must not be called like a type beside its own.
  std::string of_enumerator(const std::string& enumeration, const std::string& name) const;

 private:
  std::string unique(std::string name);

  std::map<std::string, std::string> names_;
  std::set<std::string> taken_;
  std::map<std::string, unsigned> helpers_;
};

/// Of a member, with an underscore before a word of the language.
std::string viewer_member(const std::string& name);

}  // namespace skein::recording
