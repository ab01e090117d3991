#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mission/component/component_description.hpp"

namespace skein::profile {

/// Reads a component description:
///
///     <component name="Navigator">
///       <interfaces>
///         <implements>
///           <type>IDL:AE_navigatorI/INavigator</type>
///           <required> <parameter name="..."> <type>...</type> </parameter> </required>
///           <optional> <parameter name="Time limit"/> </optional>
///           <attribute name="latency" value="100 ms"/>
///         </implements>
///       </interfaces>
///       <dependencies> <depends>IDL:AE_flightControllerI/IFlightController</depends>
///       </dependencies> <subcomponents> <subcomponent>IDL:AE_navigator/IPlanner</subcomponent>
///       </subcomponents>
///     </component>
///
/// An `implements` that has neither parameters nor attributes may hold the interface as plain text.
/// White space around text is ignored, interface names are taken in any spelling. Whether the
/// attributes and parameters exist is a question for the dictionary (check.hpp), not for this.
///
/// Throws DescriptionError with every finding: what is no UTF-8, no well-formed XML, too large
/// (8 MiB), or holds an element or an XML attribute that the notation does not have.
ComponentDescription read_component(const std::filesystem::path& file);

/// As read_component(), from text; `file` is what positions name.
ComponentDescription parse_component(std::string_view xml, const std::string& file);

/// The description in the notation that parse_component() reads. Reading it back gives the same
/// description, positions apart.
std::string write_component(const ComponentDescription& component);

}  // namespace skein::profile
