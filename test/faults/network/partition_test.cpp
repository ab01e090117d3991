#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <map>
#include <random>
#include <sstream>

#include "test/faults/processes.hpp"
#include "test/tools/cable.hpp"
#include "test/tools/seed.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

/// Two hosts at the ends of one cable, a peer on each: `left` on the server's vendor, `right` on
/// the client's. Each provides the echo service, and is connected to the other.
struct TwoHosts {
  TwoHosts() {
    left.emplace(peer("left", *Pairing::get().server, here, "10.77.0.2", {"keep_log"}));
    right.emplace(peer("right", *Pairing::get().client, there, "10.77.0.1"));
    REQUIRE(each_knows(2));
    left->send("connect right");
    left->expect("connected", 30s);
    right->send("connect left");
    right->expect("connected", 30s);
  }

  static ChildProcess peer(const std::string& name, const skein::dds::Vendor& vendor,
                           const NetworkSpace& space, const std::string& other_host,
                           std::vector<std::string> more = {}) {
    ChildProcess::Options options;
    options.network = space.descriptor();
    more.insert(more.end(), {"interface=skein0", "host=" + other_host});
    return start_provider(name, vendor, more, options);
  }

  bool each_knows(int count) {
    return eventually([&] { return services_of(*left) == count && services_of(*right) == count; });
  }

  /// One call in each direction.
  void call() {
    for (auto* one : {&*left, &*right}) call_until_connected(*one);
  }

  NetworkSpace here;
  NetworkSpace there;
  Cable cable{here, there, seed_of_this_run()};
  std::optional<ChildProcess> left;
  std::optional<ChildProcess> right;
};

}  // namespace

TEST_CASE("a provider killed on another host: its call ends as Disconnected with the lease") {
  TwoHosts hosts;
  REQUIRE(hosts.right->ask("wait") == "waiting");
  REQUIRE(eventually([&] { return hosts.left->ask("calls") == "calls 1"; }));

  hosts.right->send("outcome");
  const auto killed = std::chrono::steady_clock::now();
  hosts.left->signal(SIGKILL);
  CHECK(hosts.right->read().starts_with("error Disconnected"));
  const auto took = std::chrono::steady_clock::now() - killed;
  CHECK(eventually([&] { return services_of(*hosts.right) == 1; }));
  std::printf("killed to told, lease of 1000 ms, %s server, %s client: %.0f ms\n",
              Pairing::get().server->name().c_str(), Pairing::get().client->name().c_str(),
              std::chrono::duration<double, std::milli>(took).count());
}

TEST_CASE("a host that has lost its way to another says so in a few lines, however much it sends") {
  TwoHosts hosts;
  hosts.here.run("ip route flush dev skein0");
  // The other one, which hears nothing, while this one sends and still hears it.
  REQUIRE(eventually([&] { return services_of(*hosts.right) == 1; }));
  std::istringstream logged(hosts.left->ask("logged"));
  std::map<std::string, int> lines;  // by what is the same up to their first number
  for (std::string line; std::getline(logged, line, ';');)
    ++lines[line.substr(0, line.find_first_of("0123456789"))];
  for (const auto& [kind, count] : lines) {
    CAPTURE(kind);
    CHECK(count <= 4);  // the first, the tenth, …
  }
}

TEST_CASE("two hosts that were cut off from each other find each other again, and call") {
  TwoHosts hosts;
  hosts.call();
  SECTION("by silence on the cable") {
    hosts.cable.disturb(Disturbance::cut());
    REQUIRE(hosts.each_knows(1));
    hosts.cable.heal();
  }
  SECTION("by a pulled cable") {
    hosts.here.run("ip link set skein0 down");
    REQUIRE(hosts.each_knows(1));
    hosts.here.run("ip link set skein0 up");
  }
  REQUIRE(hosts.each_knows(2));
  hosts.call();
}

TEST_CASE("a host that was not heard, but heard the other, is found again, and both call") {
  TwoHosts hosts;
  hosts.call();
  const bool left_mute = GENERATE(true, false);
  ChildProcess& hears_nothing = left_mute ? *hosts.right : *hosts.left;
  hosts.cable.disturb(left_mute ? Cable::End::One : Cable::End::Other, Disturbance::cut());
  REQUIRE(eventually([&] { return services_of(hears_nothing) == 1; }));
  hosts.cable.heal();
  REQUIRE(hosts.each_knows(2));
  hosts.call();
}

TEST_CASE("cuts about as long as the lease leave nobody behind") {
  TwoHosts hosts;
  std::mt19937_64 random(seed_of_this_run());
  for (int i = 0; i < 4; ++i) {
    const auto cut = 700ms + std::chrono::milliseconds(random() % 700);
    INFO("cut " << i << " of " << cut.count() << " ms");
    hosts.cable.disturb(Disturbance::cut());
    let_last(cut);
    hosts.cable.heal();
    REQUIRE(hosts.each_knows(2));
    hosts.call();
  }
}
