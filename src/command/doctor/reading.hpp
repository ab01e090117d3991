#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "facts.hpp"

// How facts are read: the parts of collect_facts().
namespace skein::command::doctor {

/// The whole file; nothing where it cannot be read.
std::optional<std::string> read_file(const std::string& path);
std::optional<std::uint64_t> read_number(const std::string& path);

/// By the number of an open socket, the program that has it; of processes that may be looked into.
std::map<std::uint64_t, Program> owners_of_sockets();

std::vector<UdpSocket> read_udp_sockets(const std::map<std::uint64_t, Program>& owners);
std::vector<Launcher> read_launchers(const std::map<std::uint64_t, Program>& owners);
std::optional<std::string> read_firewall();

std::vector<VendorModule> read_vendors();
std::optional<SharedMemory> read_shared_memory(const std::string& folder);
Limits read_limits();
Processors read_processors();
std::vector<std::string> read_missing_folders();

/// What /proc/net/udp and the like say, in its own words.
struct SocketLine {
  std::uint16_t port = 0;
  std::uint64_t inode = 0;
  std::uint64_t dropped = 0;
};
std::vector<SocketLine> parse_udp(const std::string& text);

/// The version that a library's file name ends with: `2.9.1` of `libfastrtps.so.2.9.1`.
std::string version_of(const std::string& library);

}  // namespace skein::command::doctor
