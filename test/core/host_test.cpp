#include "core/system/host.hpp"

#include <catch2/catch.hpp>

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
