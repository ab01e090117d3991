#pragma once

#include <map>
#include <set>
#include <string>

#include "skein/detail/representation.hpp"
#include "skein/types.idl.hpp"

namespace skein::recording {

/// Which types consist of which. Must not outlive the type system. Functions throw InvalidArgument
/// for a type that is not declared.
class TypeGraph {
 public:
  explicit TypeGraph(const types::TypeSystem& types);

  const types::Declaration& at(const std::string& name) const;
  /// How a message of this type travels.
  Representation representation(const std::string& root) const;
  /// The declarations that `root` consists of, and itself.
  std::set<std::string> parts(const std::string& root) const;

 private:
  std::map<std::string, const types::Declaration*> declarations_;
};

/// The declared types that a type names, within sequences and the like, too.
std::set<std::string> names_in(const types::Type& type);

/// Whether XCDR2 has a length before a sequence or array of such elements. `element` is no array.
bool is_delimited(const types::Type& element, const TypeGraph& graph);

}  // namespace skein::recording
