#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

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

/// Runs a command that looks. A thing that is not found is told with the domain, and with those on
/// which missions fly here.
int look(const Onlooker& onlooker, const std::function<int()>& command);

/// On stderr, if nobody is found: the domains on which missions fly.
void tell_missions_elsewhere(const Onlooker& onlooker);

/// On stderr: what it waits for, where, and how it ends.
void tell_waiting(const Onlooker& onlooker, const char* what);

}  // namespace skein::command
