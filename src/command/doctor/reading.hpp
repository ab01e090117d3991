#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "facts.hpp"

// How facts are read: the parts of collect_facts().
namespace skein::command::doctor {

/// By the number of an open socket, the program that has it; of processes that may be looked into.
std::map<std::uint64_t, Program> owners_of_sockets();

std::vector<Launcher> read_launchers(const std::map<std::uint64_t, Program>& owners);

/// Whether a process is stopped, by a signal or a debugger.
bool is_stopped(int pid);

/// A line of /proc/net/udp.
struct SocketLine {
  std::uint16_t port = 0;
  std::uint64_t inode = 0;
  std::uint64_t dropped = 0;
};
std::vector<SocketLine> parse_udp(const std::string& text);

/// The version that a library's file name ends with: `2.9.1` of `libfastrtps.so.2.9.1`.
std::string version_of(const std::string& library);

}  // namespace skein::command::doctor
