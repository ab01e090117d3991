#pragma once

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include "harness/peer.hpp"
#include "skein/error.hpp"

/// The command line of a rival's peer: `server|client NUMBER TRANSPORT`. The number tells
/// configurations that are alive at once from each other.
namespace skein::benchmarks::rivals {

inline constexpr int kFirstPort = 20'000;

struct Arguments {
  std::string role;
  int number = 0;
  std::string transport;

  /// For transports over TCP, on loopback.
  int port() const { return kFirstPort + number; }
  /// A name in the file system for sockets and references; the server removes it.
  std::string path() const {
    return std::filesystem::temp_directory_path() / ("skein-benchmark-" + std::to_string(number));
  }
};

inline int rival_main(int argc, char** argv, const std::function<void(const Arguments&)>& peer) {
  return run_peer([&] {
    if (argc != 4) throw InvalidArgument(std::string(argv[0]) + " server|client NUMBER TRANSPORT");
    peer({argv[1], std::atoi(argv[2]), argv[3]});
  });
}

}  // namespace skein::benchmarks::rivals
