#pragma once

#include <filesystem>
#include <vector>

#include "mission/profile/mission_profile.hpp"
#include "mission/xml/finding.hpp"

namespace skein::profile {

/// Everything that is wrong with the composition of a profile, in one go and in the order of the
/// files; nothing for a clean one:
/// - a dependency that no peer provides, or that only a managed interface of another peer would
/// - a cycle of dependencies, each named once with its way round
/// - an attribute or parameter that the dictionary does not have, or whose value or declared type
///   disagrees with it; a parameter that the component does not have, or requires and is not given
/// - names given twice: peers, groups, CSPs, parameters, attributes, interfaces
/// - two peers that write one history or decision log, or one peer that writes both to one file
/// - a peer on loopback, a network inside of one process, in a mission of several processes
/// - a subcomponent without a CSP, and a CSP whose interface is no subcomponent
/// - a service reference to something that the mission does not have
/// - more than one peer that runs the mission, one that would be restarted, or that has a service
/// - a peer that is to look for others beyond this host, but names no network interface
/// - a selection strategy that is none of Skein's own where no plugin could hold it: a warning,
///   since the program may bring it
///
/// Components that could not be read (null) are passed over. A pure function; what only a machine
/// can tell is in mission/check/machine_check.hpp.
std::vector<Finding> check(const MissionProfile& profile);

/// Reads a profile, gives its parameters the values of `settings` (as apply_setting() does), and
/// checks it: adds the findings of reading and those of check() to `findings`, and gives what could
/// be read. `text`, unless null: what the file will hold. Throws nothing for what files can
/// contain; a file that is missing is a finding as well. Throws InvalidArgument for a setting that
/// a profile without errors does not take.
MissionProfile read_and_check(const std::filesystem::path& file, std::vector<Finding>& findings,
                              const VariableValues& values = {},
                              const std::vector<std::string>& settings = {},
                              const std::string* text = nullptr);

/// The findings of read_and_check().
std::vector<Finding> check_file(const std::filesystem::path& file,
                                const VariableValues& values = {});

/// Reads a profile that is going to be run: throws DescriptionError with every finding of
/// check_file() if one of them is an error.
MissionProfile read_checked_profile(const std::filesystem::path& file,
                                    const VariableValues& values = {},
                                    const std::vector<std::string>& settings = {});

}  // namespace skein::profile
