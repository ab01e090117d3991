#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/network_interface.hpp"

/// What `skein doctor` knows of a machine: plain values, so that each conclusion can be tested with
/// a machine that does not exist. What could not be read is nullopt.
namespace skein::command::doctor {

/// What the machine is to be good for.
struct Purpose {
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces;  ///< By name or address; none: 127.0.0.1 alone.
  bool multicast = false;               ///< Peers find each other by multicast.
  bool several_hosts = false;           ///< The mission has peers on other hosts.
  std::string mission;                  ///< Its name; empty where there is no profile.
  std::vector<std::string> vendors;     ///< That its peers here use; empty without a profile.
  int priority = 0;                     ///< The highest real-time priority that it asks for.
  bool locks_memory = false;
  bool shared_memory = false;
};

struct Program {
  int pid = 0;  ///< 0: another user's, which is not shown.
  std::string name;
  bool stopped = false;   ///< By a signal or a debugger: it runs no code until it is continued.
  std::string command{};  ///< Its words, where it is stopped.
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
  std::string failure;  ///< Why it cannot be loaded; empty where it can.
  std::string library;  ///< The vendor's own, as it was loaded.
  std::string version;  ///< Of that library, as its file's name tells.
  std::string tested;   ///< The version with which Skein is tested.
};

struct SystemClock {
  bool synchronised = false;
  std::chrono::microseconds stepped{0};  ///< By so much it jumped while the doctor looked.
};

/// A file of a DDS vendor's in shared memory.
struct SharedFile {
  std::string path;
  std::uint64_t size = 0;
  bool in_use = false;
};

struct SharedMemory {
  std::uint64_t free = 0;
  std::vector<SharedFile> files;  ///< Those of which it can be told whether they are in use.
};

struct Limits {
  std::optional<std::uint64_t> open_files;  ///< nullopt, here and below: no limit.
  std::optional<std::uint64_t> locked_memory;
  std::optional<std::uint64_t> address_space;
  int real_time_priority = 0;  ///< The highest that may be asked for.
};

struct Processors {
  unsigned present = 1;
  unsigned allowed = 1;                 ///< On which this process may run.
  std::optional<double> quota;          ///< So many the control group may use.
  std::optional<std::uint64_t> memory;  ///< So many bytes the control group may use.
};

struct Facts {
  std::vector<Interface> interfaces;
  std::vector<UdpSocket> sockets;
  std::vector<Launcher> launchers;
  std::optional<std::uint64_t> receive_buffer;  ///< net.core.rmem_max
  std::optional<std::uint64_t> send_buffer;     ///< net.core.wmem_max
  /// The ports that the kernel gives to sockets that ask for any.
  std::optional<std::pair<std::uint16_t, std::uint16_t>> any_ports;
  std::vector<VendorModule> vendors;
  std::optional<SystemClock> clock;
  std::optional<SharedMemory> shared_memory;
  /// The rules as nftables lists them; nullopt where they cannot be read.
  std::optional<std::string> firewall;
  Limits limits;
  Processors processors;
  std::vector<std::string> missing_folders;  ///< That SKEIN_MODULE_PATH names.
};

/// Reads all of it on this machine. Loads the vendors' modules into this process, for good.
Facts collect_facts();

}  // namespace skein::command::doctor
