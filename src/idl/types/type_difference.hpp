#pragma once

#include <optional>
#include <string>

#include "skein/types.idl.hpp"

namespace skein::idl {

/// A place in which two versions of an interface or of a type do not understand each other. All is
/// for people, and may be shown on a terminal.
struct TypeDifference {
  std::string place;  ///< `operation 'plan': parameter 'from'`, or `geo::Track.points[].height_m`.
  std::string here;   ///< What stands there on this side, as `a string`; empty: nothing.
  std::string there;  ///< The same of the other side.
};

/// `operation 'plan': parameter 'from' is a string here and a geo::Position there`; `here` and
/// `there` are what to call the two sides.
std::string in_words(const TypeDifference& difference, const std::string& here = "here",
                     const std::string& there = "there");

/// The first place at which a client of the interface `name`, of the version in `here`, does not
/// understand a provider of the version in `there`. Nothing if it does, or if one of them does not
/// describe the interface. More operations are no difference, nor is what may grow and has grown.
std::optional<TypeDifference> difference_of_interfaces(const std::string& name,
                                                       const types::TypeSystem& here,
                                                       const types::TypeSystem& there);

/// The same of the first declaration that both have.
std::optional<TypeDifference> difference_of_types(const types::TypeSystem& here,
                                                  const types::TypeSystem& there);

}  // namespace skein::idl
