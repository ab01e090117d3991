// A process of the other side is killed.
#include <csignal>

#include "harbour.hpp"
#include "test/tools/child_process.hpp"

using namespace skein::test;

namespace {

constexpr std::int64_t kLease = 60 * SKEIN_SECOND;  // buoy_peer's, too

/// Processes find each other by a vendor that is not inside one process.
bool is_inside_process() {
  return Pairing::get().server->is_inside_process() || Pairing::get().client->is_inside_process();
}

struct Peer : ChildProcess {
  Peer(const std::shared_ptr<skein::dds::Vendor>& vendor, const std::string& side)
      : ChildProcess("buoy_peer", {{vendor->name(), side}}) {}
};

std::unique_ptr<Peer> provider() {
  auto peer = std::make_unique<Peer>(Pairing::get().server, "provide");
  peer->expect("provides");
  return peer;
}

}  // namespace

TEST_CASE("a provider that is killed ends calls in C as Disconnected, and its next life serves",
          "[wire]") {
  if (is_inside_process()) return;
  auto buoy = provider();
  const CEntity caller("caller", Pairing::get().client->name(), kLease);
  const skein_proxy proxy = caller.connected(caller.fetched());
  Told told;
  const skein_call_callbacks callbacks{&told, Told::on_result, Told::on_close};
  REQUIRE(skein_proxy_start(proxy, "greet", skein_json("\"nobody\""), 60 * SKEIN_SECOND, &callbacks,
                            nullptr, caller.error));
  buoy->expect("called");
  const auto killed = std::chrono::steady_clock::now();
  buoy->signal(SIGKILL);
  REQUIRE(eventually([&] { return told.closed == 1; }));
  const auto took = std::chrono::steady_clock::now() - killed;
  INFO(std::chrono::duration_cast<std::chrono::microseconds>(took).count() << " us");
  CHECK(told.last_kind() == SKEIN_DISCONNECTED);
  CHECK(took < std::chrono::nanoseconds(kLease) / 2);

  buoy = provider();
  skein_result result{};
  if (!skein_proxy_call(proxy, "greet", skein_json("\"you\""), 20 * SKEIN_SECOND, &result,
                        caller.error)) {
    FAIL(caller.error.text());
  }
  CHECK(taken(result) == R"({"return_":"you"})");
}

TEST_CASE("a caller in C that is killed gives its call up, and the provider in C hears of it",
          "[wire]") {
  if (is_inside_process()) return;
  const auto buoy = provider();
  Peer caller(Pairing::get().client, "call");
  buoy->expect("called");
  caller.signal(SIGKILL);
  buoy->expect("cancelled");
}
