#pragma once

#include <string>

#include "skein/detail/type_support.hpp"
#include "skein/types.idl.hpp"

namespace skein {

/// What generated code says of a type, or of an interface, its bases and its operations, and of all
/// types that these name. `known` is what is to be added to; each name is there once. For those who
/// have no IDL at hand; types.idl explains the structs.
types::TypeSystem describe(const TypeSupport& type, types::TypeSystem known = {});
types::TypeSystem describe(const InterfaceInfo& interface, types::TypeSystem known = {});

/// IDL that declares all of `types`. What the IDL compiler makes of it has the same bytes on the
/// wire, the same hashes and the same signatures. Typedefs, constants, comments and bases of
/// structs are gone: what they stand for is there. Throws InvalidArgument where a type is named
/// that is not declared.
std::string to_idl(const types::TypeSystem& types);

}  // namespace skein
