#pragma once

#include <string>
#include <vector>

namespace skein::profile {
struct MissionProfile;
}

namespace skein::command::designer {

/// The entities that a mission expects on its domain.
struct Plan {
  struct Service {
    std::string name;     ///< Canonical name of the interface.
    std::string csp;      ///< Empty: the entity's public service.
    std::string process;  ///< The launcher's name for a process of its own; else empty.
    bool operator==(const Service&) const = default;
  };
  struct Entity {
    std::string name;  ///< `system/entity`
    std::string system;
    std::string process;
    std::vector<Service> services;
    std::vector<std::string> dependencies;  ///< Interfaces of others.
    bool operator==(const Entity&) const = default;
  };
  std::string file;
  std::vector<Entity> entities;
  bool operator==(const Plan&) const = default;
};

Plan plan_of(const profile::MissionProfile& mission);

}  // namespace skein::command::designer
