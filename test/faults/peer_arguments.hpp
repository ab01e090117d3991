#pragma once

#include <cstdlib>
#include <iostream>
#include <map>
#include <sstream>
#include <string>

#include "skein/entity.hpp"

namespace skein::test {

/// A peer program's arguments, `name=value`.
using PeerArguments = std::map<std::string, std::string>;

inline PeerArguments parse_arguments(int count, char** given) {
  PeerArguments arguments{
      {"vendor", "loopback"}, {"name", "peer"}, {"domain", "17"}, {"lease", "1000"}};
  for (int i = 1; i < count; ++i) {
    const std::string text = given[i];
    arguments[text.substr(0, text.find('='))] = text.substr(text.find('=') + 1);
  }
  return arguments;
}

inline EntityOptions entity_options(const PeerArguments& arguments) {
  EntityOptions options;
  options.name = arguments.at("name");
  options.system = "uav-1";
  options.vendor = dds::load_vendor(arguments.at("vendor"));
  options.domain = static_cast<std::uint32_t>(std::stoul(arguments.at("domain")));
  options.lease = std::chrono::milliseconds(std::stoul(arguments.at("lease")));
  if (arguments.contains("interface")) options.network.interfaces = {arguments.at("interface")};
  if (arguments.contains("host")) options.network.peers = {arguments.at("host")};
  options.network.multicast_discovery = arguments.contains("multicast");
  options.network.shared_memory = arguments.contains("shared_memory");
  options.shared_memory_calls = arguments.contains("shared_memory_calls") ||
                                std::getenv("SKEIN_SHARED_MEMORY_CALLS") != nullptr;
  return options;
}

/// A peer program: makes the peer, and has it obey the commands of its standard input, a line each.
/// Returns the exit code; 3 where no peer could be made.
template <class Make>
int run_peer(Make&& make) {
  const auto tell = [](const Error& error) {
    std::cout << "error " << to_string(error.code()) << ": " << error.what() << std::endl;
  };
  try {
    auto peer = make();
    for (std::string line; std::getline(std::cin, line);) {
      std::istringstream words(line);
      std::string command;
      words >> command;
      try {
        std::cout << peer->obey(command, words) << std::endl;
      } catch (const Error& error) {
        tell(error);
      }
    }
  } catch (const Error& error) {
    tell(error);
    return 3;
  }
  return 0;
}

}  // namespace skein::test
