#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mission/process/exit_codes.hpp"

namespace skein {
class Entity;
struct EntityOptions;
}  // namespace skein

namespace skein::command {

/// How a command that only looks at a domain joins it.
struct Onlooker {
  /// The system of all onlookers.
  static constexpr const char* kSystem = "tools";

  std::string vendor = "cyclonedds";
  std::optional<std::uint32_t> domain;  ///< Nothing: that of the environment, or 0.
  std::string interface;
  std::vector<std::string> peers;
  bool multicast = false;
  std::string profile;
  std::string host;
  std::vector<std::string> variables;  ///< Of the profile: NAME=VALUE.

  /// The domain that it looks at: the option's or the profile's; without either that of the
  /// variable SKEIN_DOMAIN, or 0. Throws InvalidArgument if that is no number.
  std::uint32_t watched_domain() const;

  /// What an entity of the command's `name` joins with. Throws as reading the profile does, and
  /// InvalidArgument if none of its peers is of this host, or options are missing.
  EntityOptions entity_options(const std::string& name) const;
};

/// Joins the domain. Throws as entity_options(), and Internal if that fails: nothing was looked
/// for yet.
Entity join(const Onlooker& onlooker, const std::string& name);

inline constexpr const char* kDomainVariable = "SKEIN_DOMAIN";

/// Of commands that look: the thing is not there, or did not answer.
inline constexpr int kNothingThere = 69;
inline constexpr int kNoAnswer = 124;

/// All that a command ends with that looks at a domain or at a recording.
inline constexpr std::array kLookingExitCodes{
    launch::ExitCode{"0", "done"},
    launch::ExitCode{"1",
                     "call: it ended with an exception that its interface declares; echo: fewer "
                     "values than --count came; info: the file holds nothing; param set: the "
                     "component refuses the value; decisions --replay, replay --decisions: one "
                     "comes out differently"},
    launch::ExitCode{"64", "the command line is wrong; nothing was done"},
    launch::ExitCode{"69",
                     "no service, entity or topic of that name is there, or it has gone; record: "
                     "nothing was recorded"},
    launch::ExitCode{"71", "it could not join the domain, or the call failed at the other side"},
    launch::ExitCode{"74", "the output, or a file, could not be made or written"},
    launch::ExitCode{"78", "a file, a name, JSON or a parameter's value is wrong"},
    launch::ExitCode{"124", "no answer came in time"},
    launch::ExitCode{"128 + N", "interrupted by signal N before it was done"},
};

/// Runs a command that looks. A thing that is not found is told with the domain, and with those on
/// which missions fly here.
int look(const Onlooker& onlooker, const std::function<int()>& command);

/// On stderr, if nobody is found: the domains on which missions fly.
void tell_missions_elsewhere(const Onlooker& onlooker);

/// On stderr: what it waits for, where, and how it ends.
void tell_waiting(const Onlooker& onlooker, const char* what);

}  // namespace skein::command
