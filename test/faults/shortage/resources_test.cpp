#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "dds/port/port.hpp"
#include "test/connector/echo_service.hpp"
#include "test/faults/processes.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;

namespace {

constexpr std::uint16_t kFirstPort = 7410 + 250 * 17;

/// Takes the ports of the first participants of the tests' domain on loopback.
class TakenPorts {
 public:
  explicit TakenPorts(int participants) {
    for (int i = 0; i < participants * 2; ++i) {
      const int taken = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      address.sin_port = htons(static_cast<std::uint16_t>(kFirstPort + i));
      REQUIRE(bind(taken, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
      sockets_.push_back(taken);
    }
  }
  ~TakenPorts() {
    for (const int taken : sockets_) close(taken);
  }

 private:
  std::vector<int> sockets_;
};

void call_once() {
  const auto server = make_server();
  server->provide<LouderEcho>(std::make_shared<EchoService>());
  const auto client = make_client();
  CHECK(client->connect<LouderEcho>({.timeout = 20s}).echo("x") == "x");
}

}  // namespace

TEST_CASE("peers find other ports, and each other, where the first ones are taken") {
  const TakenPorts taken(10);
  call_once();
}

TEST_CASE("with all ports taken an entity says so, and comes to be once some are free") {
  {
    const TakenPorts taken(120);
    for (const auto& make : {make_server, make_client}) {
      CHECK_THROWS_AS(make("late"), Unavailable);
      CHECK_THROWS_WITH(make("late"), Catch::Contains("domain 17") && Catch::Contains("port"));
    }
  }
  call_once();
}

TEST_CASE("in the last domain, which has ports for fewer participants, peers find each other") {
  std::vector<std::unique_ptr<Entity>> entities;
  for (const auto& vendor : {Pairing::get().server, Pairing::get().client}) {
    EntityOptions options;
    options.name = entities.empty() ? "server" : "client";
    options.vendor = vendor;
    options.domain = 232;
    entities.push_back(std::make_unique<Entity>(options));
  }
  entities[0]->provide<LouderEcho>(std::make_shared<EchoService>());
  CHECK(entities[1]->connect<LouderEcho>({.timeout = 20s}).echo("x") == "x");
}

TEST_CASE("an entity of the last domain comes to be however many there were before") {
  for (const auto& vendor : {Pairing::get().server, Pairing::get().client}) {
    for (int i = 0; i < 70; ++i) {
      dds::ParticipantOptions options;
      options.domain = 232;
      REQUIRE_NOTHROW(vendor->create_participant(options));
    }
  }
}
