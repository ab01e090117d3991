#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/system/network_interface.hpp"

/// What `skein doctor` knows of a machine: plain values, so that each conclusion can be tested with
/// a machine that does not exist. A fact that could not be read is nullopt.
namespace skein::command::doctor {

/// What the machine is to be good for.
struct Purpose {
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces;  ///< By name or address; none: 127.0.0.1 alone.
  bool multicast = false;               ///< Peers find each other by multicast.
  bool several_hosts = false;           ///< The mission has peers on other hosts.
  std::string mission;                  ///< Its name; empty without a profile.
  std::vector<std::string> vendors;     ///< That its peers here use; empty without a profile.
  int priority = 0;                     ///< The highest real-time priority that it asks for.
  bool locks_memory = false;
  bool shared_memory = false;
};

struct Program {
  int pid = 0;  ///< 0: another user's, which is not shown.
  std::string name;
  bool stopped = false;   ///< By a signal or a debugger: it runs no code until it is continued.
  std::string command{};  ///< Its words, if it is stopped.
};

using Interface = NetworkInterface;

struct UdpSocket {
  std::uint16_t port = 0;
  std::uint64_t dropped = 0;  ///< Packets for which it had no room.
  Program owner;
};

/// A `skein launch` that runs.
struct Launcher {
  std::uint32_t domain = 0;
  Program program;
};

struct VendorModule {
  std::string name;
  std::string failure;              ///< Why it cannot be loaded; empty if it can.
  std::string library;              ///< The vendor's own, as it was loaded.
  std::string version;              ///< Of that library, as its file's name tells.
  std::vector<std::string> tested;  ///< The versions with which Skein is tested.
};

struct Limits {
  std::optional<std::uint64_t> open_files;  ///< nullopt, here and below: no limit.
  std::optional<std::uint64_t> locked_memory;
  int real_time_priority = 0;  ///< The highest that may be asked for.
};

struct Facts {
  std::vector<Interface> interfaces;
  std::vector<UdpSocket> sockets;
  std::vector<Launcher> launchers;
  std::uint64_t buffer = 0;  ///< The bytes of a UDP socket that asks for more.
  std::vector<VendorModule> vendors;
  std::optional<bool> synchronised_clock;
  std::optional<std::uint64_t> free_shared_memory;
  /// The rules as nftables lists them; nullopt if they cannot be read.
  std::optional<std::string> firewall;
  Limits limits;
};

/// Reads all of it on this machine. Loads the vendors' modules into this process, for good.
Facts collect_facts();

}  // namespace skein::command::doctor
