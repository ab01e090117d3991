// An entity in a global object, which ends after main(), with a service, a connection and topics.
#include <cstdio>
#include <memory>
#include <optional>

#include "skein/error.hpp"
#include "test/connector/echo_service.hpp"
#include "test/faults/shortage/lone_entity.hpp"

using namespace skein;
using ::test::LouderEcho;

namespace {

/// Ends last of all: it came first.
struct Peers {
  ~Peers() {
    proxy.reset();
    server.reset();
    client.reset();
    std::printf("ended\n");
    std::fflush(stdout);
  }
  std::unique_ptr<Entity> server;
  std::unique_ptr<Entity> client;
  std::optional<LouderEcho::Proxy> proxy;
} peers;

}  // namespace

int main(int, char** arguments) {
  try {
    const auto vendor = dds::load_vendor(arguments[1]);
    peers.server = skein::test::make_lone_entity(vendor, "server");
    peers.server->provide<LouderEcho>(std::make_shared<skein::test::EchoService>());
    peers.client = skein::test::make_lone_entity(vendor, "client");
    peers.proxy.emplace(peers.client->connect<LouderEcho>());
    std::printf("%s\n", peers.proxy->echo("called").c_str());
  } catch (const Error& error) {
    std::printf("error %s\n", error.what());
    return 1;
  }
}
