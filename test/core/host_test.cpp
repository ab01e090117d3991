#include "core/system/host.hpp"

#include <catch2/catch.hpp>

#include "core/system/network_interface.hpp"
#include "skein/error.hpp"

using namespace skein;

TEST_CASE("this host is known by its name and by each of its addresses") {
  const std::string name = name_of_this_host();
  REQUIRE_FALSE(name.empty());
  CHECK(is_this_host(name));
  CHECK(is_this_host(name.substr(0, name.find('.'))));
  for (const HostInterface& interface : interfaces_of_this_host())
    CHECK(is_this_host(interface.address));
  CHECK(is_this_host("127.3.2.1"));
  CHECK(is_this_host("localhost"));
}

TEST_CASE("another address, and a name that nobody knows, is not this host") {
  CHECK_FALSE(is_this_host("192.0.2.1"));
  CHECK_FALSE(is_this_host("no-such-host.invalid"));
  CHECK_THROWS_WITH(host_addresses("no-such-host.invalid"),
                    Catch::Contains("host 'no-such-host.invalid' has no IPv4 address"));
  CHECK(host_addresses("192.0.2.1") == std::vector<std::string>{"192.0.2.1"});
}

TEST_CASE("interfaces are listed for people with their addresses") {
  CHECK(to_text({}) == "none");
  CHECK(to_text({{"lo", "127.0.0.1"}, {"eth0", "10.0.0.2"}}) == "lo (127.0.0.1), eth0 (10.0.0.2)");
}

TEST_CASE("an interface that is up and has no address yet is an obstacle") {
  NetworkInterface eth0{.name = "eth0", .addresses = {}, .up = true};
  const auto obstacle = find_obstacle({eth0}, "eth0");
  REQUIRE(obstacle);
  CHECK(obstacle->problem == "the interface eth0 has no IPv4 address, and Skein speaks IPv4");
  eth0.addresses = {"10.0.0.2"};
  CHECK_FALSE(find_obstacle({eth0}, "eth0"));
}

TEST_CASE("an interface that is not there is misspelled, or a device that may still come") {
  const std::vector<std::string> known{"lo", "eth0", "wlp2s0"};
  for (const char* slip : {"etho", "ehh0", "l0", "lo0", "wlps20"}) {
    CAPTURE(slip);
    CHECK(is_misspelled_interface(slip, known));
  }
  for (const char* device : {"eth1", "wlp13s0", "usb0", "wlan0", "10.0.0.3"}) {
    CAPTURE(device);
    CHECK_FALSE(is_misspelled_interface(device, known));
  }
}
