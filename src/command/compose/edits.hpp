#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "design_state.idl.hpp"
#include "mission/xml/xml_source.hpp"
#include "repository.hpp"

namespace skein::command::compose {

/// A change of the text of a mission.
struct Edit {
  std::string label;  ///< In words.
  std::string key;    ///< As TextHistory::edit() has it.
  profile::Splice splice;
};

/// The mission that is edited. Holds references.
struct Edited {
  const profile::XmlSource& source;
  const DesignState& design;
  const Repository& repository;
};

/// The edit that a page asks for, a JSON object: `"do"` is
/// - `set`: gives the `element` the `attribute` with the `value`; null takes it away
/// - `parameter`: gives the `element`'s parameter of that `name` a `value`; null takes it away
/// - `add_entity`: the `component` of that file, in the group `element`, if there is one
/// - `add_csp`: the `component` of that file, to the peer `element`, if it fits one of its slots
/// - `add`: a `child` to the `element`, with `attributes`
/// - `remove`: takes the `element` away
/// Throws InvalidArgument for a request that is none, for elements and attributes that the notation
/// does not have, and for a CSP that does not fit.
Edit edit_of(const nlohmann::json& request, const Edited& edited);

}  // namespace skein::command::compose
