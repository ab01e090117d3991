#include <algorithm>
#include <catch2/catch.hpp>

#include "call_port/dds_call_port.hpp"
#include "entity/entity_access.hpp"
#include "test/faults/messages.hpp"
#include "test/faults/processes.hpp"
#include "test/tools/network_space.hpp"
#include "test/tools/wire_tap.hpp"

using namespace skein::test;
using namespace std::chrono_literals;

namespace {

struct Idle {
  std::string name;
  std::set<std::uint16_t> ports;
};

// RTPS 9.3.1.2: the kind of an application's writer without a key, in the last octet of its GUID.
constexpr std::uint8_t kKeylessWriter = 0x03;

/// DATA and DATA_FRAG submessages of calls to these ports in which `text` stands. Calls travel on
/// topics without a key; services' descriptions and loads, which go to everybody, on topics with
/// one.
std::size_t data_to(const Idle& idle, const std::vector<Packet>& packets,
                    std::string_view text = "") {
  std::size_t count = 0;
  for (const Packet& packet : packets) {
    if (!idle.ports.contains(packet.destination_port)) continue;
    for (const DataSubmessage& data : user_data(packet)) {
      const bool is_call = data.writer.bytes.back() == kKeylessWriter;
      count += is_call && data.payload.find(text) != std::string_view::npos ? 1 : 0;
    }
  }
  return count;
}

/// A busy pair of the two vendors, and beside it idle providers and idle clients on both vendors.
/// Made in the network namespace of the calling thread.
struct Neighbours {
  Neighbours() : vendors{Pairing::get().server, Pairing::get().client} {
    busy_server.emplace(start("busy_server", *vendors[0]));
    provide(*busy_server);
    busy_client.emplace(start("busy_client", *vendors[1]));
    connect(*busy_client);
    for (const auto& vendor : vendors) {
      idle_servers.push_back(start("idle_server_on_" + vendor->name(), *vendor));
      provide(idle_servers.back());
      idle_clients.push_back(start("idle_client_on_" + vendor->name(), *vendor));
      connect(idle_clients.back());
    }
    for (auto& client : idle_clients) REQUIRE(eventually([&] { return services_of(client) == 3; }));
    REQUIRE(eventually([&] { return services_of(*busy_client) == 3; }));
  }

  static ChildProcess start(const std::string& name, const skein::dds::Vendor& vendor) {
    return start_peer(name, vendor);
  }
  static void provide(ChildProcess& peer) {
    peer.send("provide");
    peer.expect("provided");
  }
  static void connect(ChildProcess& peer) {
    peer.send("connect busy_server");
    peer.expect("connected", 30s);
  }

  static std::vector<Idle> ports(std::vector<ChildProcess>& peers, const std::string& kind) {
    std::vector<Idle> idle;
    for (ChildProcess& peer : peers) idle.push_back({kind, udp_ports_of(peer.pid())});
    return idle;
  }

  void work(const std::string& text) {
    busy_client->send("echo 100 " + text);
    busy_client->expect("echoed", 60s);
    busy_client->send("octets 200000 " + text);
    busy_client->expect("echoed", 60s);
  }

  std::vector<std::shared_ptr<skein::dds::Vendor>> vendors;
  std::optional<ChildProcess> busy_server;
  std::optional<ChildProcess> busy_client;
  std::vector<ChildProcess> idle_servers;
  std::vector<ChildProcess> idle_clients;
};

}  // namespace

TEST_CASE(
    "an idle client receives nothing of others' replies, an idle provider nothing of others' "
    "requests") {
  const NetworkSpace space;
  const Inside inside(space);
  Neighbours neighbours;
  const Idle busy{"busy client", udp_ports_of(neighbours.busy_client->pid())};
  std::vector<Idle> all = Neighbours::ports(neighbours.idle_clients, "idle client");
  for (const Idle& server : Neighbours::ports(neighbours.idle_servers, "idle provider"))
    all.push_back(server);

  // Only that is theirs: what an idle client was told when it connected may be told once more.
  const std::string said = "said-between-two";
  WireTap tap;
  neighbours.work(said);
  const auto packets = tap.stop();
  CHECK(data_to(busy, packets, said) > 100);
  for (const Idle& idle : all) {
    INFO(idle.name);
    CHECK(idle.ports.size() >= 2);
    CHECK(data_to(idle, packets, said) == 0);
  }
}

TEST_CASE("the capture sees what does go to those who were idle") {
  const NetworkSpace space;
  const Inside inside(space);
  Neighbours neighbours;
  const auto clients = Neighbours::ports(neighbours.idle_clients, "client");
  const auto servers = Neighbours::ports(neighbours.idle_servers, "provider");

  WireTap tap;
  for (ChildProcess& client : neighbours.idle_clients) {
    client.send("echo 1 hello");
    client.expect("echoed");
  }
  // Requests to all providers at once, as clients without Skein send them.
  const auto foreigner = entity_with_lease("foreigner", neighbours.vendors[1], 1000ms);
  skein::dds::Qos qos;
  qos.partitions = {""};
  const auto requests =
      skein::EntityAccess::participant(*foreigner)
          .create_writer(skein::calls::request_topic({"test/LouderEcho", {}}), qos);
  CHECK(eventually([&] {
    requests->write(echo_request(requests->guid()));
    return std::ranges::all_of(neighbours.idle_servers, [](ChildProcess& server) {
      return server.ask("calls") != "calls 0";
    });
  }));
  const auto packets = tap.stop();
  for (const Idle& client : clients) CHECK(data_to(client, packets) > 0);
  for (const Idle& server : servers) CHECK(data_to(server, packets) > 0);
}
