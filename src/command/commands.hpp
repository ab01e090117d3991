#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "onlooker.hpp"

/// The subcommands of `skein`: what the command line in main.cpp tells each, and the function that
/// runs it. It returns the exit code; main.cpp has one for whatever it throws.
namespace skein::command {

struct BenchArguments {
  std::string vendor = "cyclonedds";
  std::uint32_t domain = 99;
  std::string interface;  ///< Empty: loopback.
  std::string peer;       ///< The other host's address, where they speak on an interface.
  std::string profile;    ///< A mission profile: vendor, interface and threads are its peers'.
  std::string provider;   ///< Its peer that is called; empty: its first.
  std::string caller;     ///< Its peer that calls; empty: the provider.
  std::vector<std::size_t> payloads{64, 1024, 65'536, 1'048'576};
  std::size_t count = 1000;
  std::size_t in_flight = 64;
  bool serve = false;   ///< Be the other side, until ended.
  bool remote = false;  ///< The other side runs already, elsewhere.
  std::string output;
};

/// `skein bench latency|throughput|discovery`: what calls cost here.
int bench_latency(const BenchArguments& arguments);
int bench_throughput(const BenchArguments& arguments);
int bench_discovery(const BenchArguments& arguments);

struct BenchCompareArguments {
  std::string before;
  std::string after;
};

/// `skein bench compare A B`: prints the rows that two saved results share, with the quotient of
/// their medians. Throws InvalidArgument where a file holds no result, or where they share none.
int bench_compare(const BenchCompareArguments& arguments);

struct CallsArguments : Onlooker {
  double seconds = 0;  ///< 0: until interrupted.
};

/// `skein calls`: what happens to each call on a domain, live.
int show_calls(const CallsArguments& arguments);

struct CheckArguments {
  std::string profile;
  std::string host;
};

/// `skein check PROFILE`: everything that is wrong with a mission profile.
int check(const CheckArguments& arguments);

struct DecisionsArguments : Onlooker {
  double seconds = 0;  ///< 0: until interrupted.
  std::string log;     ///< Empty: live.
  bool replays = false;
  std::vector<std::string> plugins;
};

/// `skein decisions`: how the Heads on a domain decide, live or from a log. 1 where a replay comes
/// out differently.
int show_decisions(const DecisionsArguments& arguments);

struct MissionArguments {
  std::string profile;
  std::vector<std::string> settings;
};

struct LaunchArguments : MissionArguments {
  std::string host;
  bool dry_run = false;
  bool verbose = false;
};

/// `skein launch PROFILE`: each peer in a process of its own.
int launch(const LaunchArguments& arguments);

struct PeerArguments : MissionArguments {
  std::string process;
};

/// `skein peer PROFILE PROCESS`: one process of a mission, as `launch` starts it.
int run_peer(const PeerArguments& arguments);

struct ServicesArguments : Onlooker {
  double seconds = 1.5;
  bool statistics = false;
};

/// `skein services`: what is provided on a domain now.
int list_services(const ServicesArguments& arguments);

}  // namespace skein::command
