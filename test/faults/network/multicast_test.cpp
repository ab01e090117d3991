#include <catch2/catch.hpp>

#include "test/faults/processes.hpp"
#include "test/tools/network_space.hpp"

using namespace skein::test;

namespace {

/// Two hosts, a peer on each, that find each other by multicast on device `skein0`, which the test
/// makes and takes away.
struct TwoHosts {
  explicit TwoHosts(const std::string& vendor_name) : vendor(skein::dds::load_vendor(vendor_name)) {
    make_devices();
    left.emplace(provider("left", here));
    right.emplace(provider("right", there));
  }

  ChildProcess provider(const std::string& name, const NetworkSpace& space) const {
    ChildProcess::Options options;
    options.network = space.descriptor();
    auto peer = start_peer(name, *vendor, {"interface=skein0", "multicast"}, options);
    peer.send("provide");
    peer.expect("provided");
    return peer;
  }

  void make_devices() const { join(here, there, "10.77.0"); }
  void take_devices() const { here.run("ip link delete skein0"); }

  bool each_knows(int count) {
    return eventually([&] { return services_of(*left) == count && services_of(*right) == count; });
  }

  std::shared_ptr<skein::dds::Vendor> vendor;
  NetworkSpace here;
  NetworkSpace there;
  std::optional<ChildProcess> left;
  std::optional<ChildProcess> right;
};

}  // namespace

TEST_CASE("peers find each other by multicast again after their network device went and came") {
  const std::string vendor = GENERATE("fastdds", "cyclonedds");
  CAPTURE(vendor);
  TwoHosts hosts(vendor);
  REQUIRE(hosts.each_knows(2));
  hosts.take_devices();
  REQUIRE(hosts.each_knows(1));
  hosts.make_devices();
  CHECK(hosts.each_knows(2));
  // Cyclone remembers where others were. Nobody knows of this one yet.
  auto newcomer = hosts.provider("newcomer", hosts.there);
  CHECK(hosts.each_knows(3));
}
