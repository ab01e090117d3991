#include <sched.h>
#include <signal.h>
#include <sys/mount.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>

#include "test/faults/processes.hpp"
#include "test/tools/wire_tap.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

constexpr const char* kFolder = "/dev/shm";
constexpr std::size_t kLargeBytes = 1 << 20;

/// Hides the machine's shared memory behind one of this test's own, for it and the processes that
/// it starts.
void hide_shared_memory() {
  static const bool hidden = unshare(CLONE_NEWNS) == 0 &&
                             mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                             mount("tmpfs", kFolder, "tmpfs", MS_NOSUID | MS_NODEV, nullptr) == 0;
  if (hidden) return;
  std::fprintf(stderr, "skipped: the test may not have a /dev/shm of its own (run it as root)\n");
  std::_Exit(77);
}

/// Another one in front of that, of its own size, while this lives.
class SmallSharedMemory {
 public:
  explicit SmallSharedMemory(const char* size) {
    REQUIRE(mount("tmpfs", kFolder, "tmpfs", MS_NOSUID | MS_NODEV, size) == 0);
  }
  ~SmallSharedMemory() { umount2(kFolder, MNT_DETACH); }
  SmallSharedMemory(const SmallSharedMemory&) = delete;
  SmallSharedMemory& operator=(const SmallSharedMemory&) = delete;
};

std::ptrdiff_t segments() {
  return std::distance(std::filesystem::directory_iterator(kFolder),
                       std::filesystem::directory_iterator());
}

/// A provider and a caller, each a process, that call each other as long as this lives.
struct Pair {
  Pair(const std::string& server_vendor, const std::vector<std::string>& server_options,
       const std::string& client_vendor, const std::vector<std::string>& client_options)
      : server(start_provider("server", *dds::load_vendor(server_vendor), server_options)),
        client(start_client("client", *dds::load_vendor(client_vendor), client_options)) {}

  /// How many UDP packets the large call took that are as large as one that carries a part of it.
  std::ptrdiff_t call() {
    client.send("echo 100 hello");
    client.expect("echoed", 30s);
    WireTap tap;
    client.send("octets " + std::to_string(kLargeBytes) + " large");
    client.expect("echoed", 30s);
    const auto packets = tap.stop();
    return std::ranges::count_if(packets,
                                 [](const Packet& packet) { return packet.content.size() > 4096; });
  }

  ChildProcess server;
  ChildProcess client;
};

const std::vector<std::string> kPlain{};
const std::vector<std::string> kShared{"shared_memory"};

}  // namespace

TEST_CASE("by default a peer opens no segment of shared memory") {
  hide_shared_memory();
  const std::string vendor = GENERATE("fastdds", "cyclonedds");
  CAPTURE(vendor);
  const std::ptrdiff_t before = segments();
  Pair pair(vendor, kPlain, vendor, kPlain);
  CHECK(pair.call() > 0);
  CHECK(segments() == before);
}

TEST_CASE("peers that want shared memory call each other by it") {
  hide_shared_memory();
  Pair pair("fastdds", kShared, "fastdds", kShared);
  CHECK(pair.call() == 0);
  CHECK(segments() > 0);
}

TEST_CASE("a peer with shared memory and one without it call each other by UDP") {
  hide_shared_memory();
  const auto& [server, client, vendor] =
      GENERATE(table<std::vector<std::string>, std::vector<std::string>, std::string>(
          {{kShared, kPlain, "fastdds"},
           {kPlain, kShared, "fastdds"},
           {kShared, kPlain, "cyclonedds"}}));
  Pair pair("fastdds", server, vendor, client);
  CHECK(pair.call() > 0);
}

TEST_CASE(
    "a caller hears at once of the death of a provider in shared memory, and finds the next one") {
  hide_shared_memory();
  Pair pair("fastdds", kShared, "fastdds", kShared);
  CHECK(pair.client.ask("wait") == "waiting");
  pair.server.signal(SIGKILL);
  CHECK_THAT(pair.client.ask("outcome"), Contains("Disconnected"));
  const auto next = start_provider("server", *dds::load_vendor("fastdds"), kShared);
  pair.client.send("connect");
  pair.client.expect("connected", 30s);
  CHECK(pair.call() == 0);
}

TEST_CASE("a peer for which there is no room in shared memory does without it, and says so") {
  hide_shared_memory();
  const auto* size = GENERATE("size=1m", "size=24m");  // for none, for one
  CAPTURE(size);
  const SmallSharedMemory small(size);
  const std::vector<std::string> options{"shared_memory", "keep_log"};
  Pair pair("fastdds", options, "fastdds", options);
  CHECK(pair.call() > 0);
  const std::string logged = pair.server.ask("logged") + pair.client.ask("logged");
  CHECK_THAT(logged, Contains("' does without shared memory: /dev/shm has no 17 MiB left (No space "
                              "left on device); make room"));
}

TEST_CASE("a vendor without shared memory says so") {
  const std::string vendor = GENERATE("cyclonedds", "loopback");
  CAPTURE(vendor);
  auto peer = start_peer("peer", *dds::load_vendor(vendor), kShared);
  CHECK_THAT(peer.read(),
             Contains("InvalidArgument") && Contains("shared memory") && Contains("'fastdds'"));
  CHECK(peer.finish() == 3);
}
