#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "../tools/cable.hpp"
#include "../tools/seed.hpp"
#include "../tools/wire_tap.hpp"
#include "processes.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

/// A file that goes with the test.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text)
      : path_(std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_" + name)) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

constexpr const char* kProfiles = R"(<?xml version="1.0" encoding="UTF-8"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <participant profile_name="elsewhere" is_default_profile="true">
    <domainId>17</domainId>
    <rtps>
      <useBuiltinTransports>true</useBuiltinTransports>
      <builtin>
        <initialPeersList>
          <locator><udpv4><address>10.77.0.2</address></udpv4></locator>
          <locator><udpv4><address>239.255.0.1</address><port>11650</port></udpv4></locator>
        </initialPeersList>
      </builtin>
    </rtps>
  </participant>
</profiles>)";

constexpr const char* kUri =
    "CYCLONEDDS_URI=<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface "
    "name=\"skein0\" "
    "multicast=\"true\"/></Interfaces><AllowMulticast>true</AllowMulticast></"
    "General><Discovery><Peers>"
    "<Peer Address=\"10.77.0.2\"/></Peers></Discovery></Domain></CycloneDDS>";

/// A host with a network beside its loopback device, over which everything would go that asks for a
/// way.
struct Host {
  Host() { space.run("ip route add default via 10.77.0.2"); }
  NetworkSpace space;
  NetworkSpace outside;
  Cable cable{space, outside, seed_of_this_run()};
};

/// How many packets a pair that calls once sends beyond loopback.
std::size_t packets_beyond_loopback(const std::vector<std::string>& environment,
                                    const std::vector<std::string>& arguments = {}) {
  const Host host;
  const Inside inside(host.space);
  WireTap tap;
  {
    ChildProcess::Options options;
    options.environment = environment;
    auto server = start_peer("server", *Pairing::get().server, arguments, options);
    auto client = start_peer("client", *Pairing::get().client, arguments, options);
    server.send("provide");
    server.expect("provided");
    client.send("connect\necho 10 hello");
    client.expect("connected", 30s);
    client.expect("echoed");
    CHECK(client.finish() == 0);
    CHECK(server.finish() == 0);
  }
  const auto packets = tap.stop();
  return static_cast<std::size_t>(std::ranges::count_if(
      packets, [](const Packet& packet) { return !packet.stays_on_loopback(); }));
}

}  // namespace

TEST_CASE("an environment that names other hosts moves no packet off loopback") {
  const TemporaryFile profiles("profiles.xml", kProfiles);
  const TemporaryFile more(
      "environment.json",
      R"({"environment_variables": {"ROS_DISCOVERY_SERVER": "10.77.0.2:11811"}})");
  CHECK(packets_beyond_loopback({kUri, "FASTRTPS_DEFAULT_PROFILES_FILE=" + profiles.path(),
                                 "FASTDDS_DEFAULT_PROFILES_FILE=" + profiles.path(),
                                 "ROS_DISCOVERY_SERVER=10.77.0.2:11811",
                                 "FASTDDS_ENVIRONMENT_FILE=" + more.path(), "ROS_DOMAIN_ID=99",
                                 "ROS_LOCALHOST_ONLY=0"}) == 0);
}

TEST_CASE("an environment that makes no sense keeps nobody from calling") {
  const TemporaryFile profiles("profiles.xml", "<profiles><participant");
  CHECK(packets_beyond_loopback({"CYCLONEDDS_URI=<CycloneDDS><Domain", "ROS_DISCOVERY_SERVER=:::;;",
                                 "FASTRTPS_DEFAULT_PROFILES_FILE=" + profiles.path(),
                                 "FASTDDS_ENVIRONMENT_FILE=/nowhere"}) == 0);
}

TEST_CASE("the capture sees packets of a pair that was told to use the network") {
  CHECK(packets_beyond_loopback({}, {"interface=skein0", "multicast"}) > 0);
}
