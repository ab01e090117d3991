#pragma once

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <string>

#include "skein/entity/entity.hpp"

namespace skein::command {

/// Where a command that only looks at a domain joins it.
struct Onlooker {
  std::string vendor = "cyclonedds";
  std::uint32_t domain = 0;
  std::string interface;

  void add_options(CLI::App& command) {
    command.add_option("--vendor", vendor, "fastdds or cyclonedds")->capture_default_str();
    command.add_option("--domain", domain, "DDS domain of the mission")->capture_default_str();
    command.add_option("--interface", interface, "Network interface; loopback by default");
  }

  /// What an entity of the command's `name` joins with.
  EntityOptions entity_options(const std::string& name) const {
    EntityOptions options;
    options.name = "skein-" + name + "-" + std::to_string(getpid());
    options.system = "tools";
    options.vendor = dds::load_vendor(vendor);
    options.domain = domain;
    if (!interface.empty()) options.network.interfaces = {interface};
    return options;
  }
};

}  // namespace skein::command
