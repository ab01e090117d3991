#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "test/faults/processes.hpp"
#include "test/tools/cable.hpp"
#include "test/tools/seed.hpp"
#include "test/tools/wire_tap.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

/// A folder in which the peers run, and which goes with the test.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "skein_XXXXXX").string();
    path_ = mkdtemp(pattern.data());
    std::filesystem::current_path(path_);
  }
  ~Folder() {
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Returns the file's path.
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(path_ / name) << text;
    ++written_;
    return path_ / name;
  }
  /// Whether nobody else has written a file here.
  bool untouched() const {
    return std::distance(std::filesystem::directory_iterator(path_), {}) == written_;
  }

 private:
  const std::filesystem::path before_ = std::filesystem::current_path();
  std::filesystem::path path_;
  std::ptrdiff_t written_ = 0;
};

constexpr const char* kProfiles = R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <log><use_default>FALSE</use_default><consumer><class>FileConsumer</class>
    <property><name>filename</name><value>fastdds.log</value></property></consumer></log>
  <profiles>
    <participant profile_name="elsewhere" is_default_profile="true">
      <domainId>99</domainId>
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
  </profiles></dds>)";

constexpr const char* kUri =
    "CYCLONEDDS_URI=<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface "
    "name=\"skein0\" multicast=\"true\"/></Interfaces><AllowMulticast>true</AllowMulticast></"
    "General><Discovery><Peers><Peer Address=\"10.77.0.2\"/></Peers>"
    "<ExternalDomainId>99</ExternalDomainId></Discovery><Tracing><Verbosity>finest</Verbosity>"
    "<OutputFile>trace.log</OutputFile></Tracing></Domain></CycloneDDS>";

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
    auto server = start_provider("server", *Pairing::get().server, arguments, options);
    auto client = start_client("client", *Pairing::get().client, arguments, options);
    client.send("echo 10 hello");
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
  Folder folder;
  folder.write("DEFAULT_FASTRTPS_PROFILES.xml", kProfiles);
  const std::string profiles = folder.write("profiles.xml", kProfiles);
  const std::string more =
      folder.write("environment.json",
                   R"({"environment_variables": {"ROS_DISCOVERY_SERVER": "10.77.0.2:11811"}})");
  CHECK(packets_beyond_loopback(
            {kUri, "FASTRTPS_DEFAULT_PROFILES_FILE=" + profiles,
             "FASTDDS_DEFAULT_PROFILES_FILE=" + profiles, "ROS_DISCOVERY_SERVER=10.77.0.2:11811",
             "FASTDDS_ENVIRONMENT_FILE=" + more, "ROS_DOMAIN_ID=99", "ROS_LOCALHOST_ONLY=0",
             "FASTDDS_STATISTICS=HISTORY_LATENCY_TOPIC;DATA_COUNT_TOPIC",
             "FASTDDS_BUILTIN_TRANSPORTS=LARGE_DATA"}) == 0);
  CHECK(folder.untouched());
}

TEST_CASE("an environment that makes no sense keeps nobody from calling") {
  Folder folder;
  CHECK(packets_beyond_loopback({"CYCLONEDDS_URI=<CycloneDDS><Domain", "ROS_DISCOVERY_SERVER=:::;;",
                                 "FASTRTPS_DEFAULT_PROFILES_FILE=" +
                                     folder.write("profiles.xml", "<profiles><participant"),
                                 "FASTDDS_ENVIRONMENT_FILE=/nowhere"}) == 0);
}

TEST_CASE("the capture sees packets of a pair that was told to use the network") {
  CHECK(packets_beyond_loopback({}, {"interface=skein0", "multicast"}) > 0);
}
