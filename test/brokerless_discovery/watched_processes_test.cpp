#include "brokerless_discovery/watched_processes.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "skein/guid.hpp"
#include "test/tools/eventually.hpp"

using namespace skein::brokerless_discovery;
using namespace std::chrono_literals;
using skein::Epoll;
using skein::FileDescriptor;

namespace {

const int kOne = 1;
const int kTwo = 2;

/// A process that others watch: this one.
struct Other {
  std::string address = "skein/" + skein::Guid::random().hex();
  skein::ListeningSocket listening{skein::local_socket()};

  Other() { REQUIRE(listen_at(listening, address)); }
  FileDescriptor accept() const { return skein::accept_at(listening.get()); }
};

bool watch(WatchedProcesses& watched, const std::string& address, const void* watcher) {
  WatchedProcesses::Action action = [] {};
  return watched.watch(address, watcher, action);
}

/// Handles what the kernel reports, and counts the actions that are due.
std::size_t handle(Epoll& epoll, WatchedProcesses& watched) {
  std::vector<WatchedProcesses::Action> ended;
  for (const auto& event : epoll.wait(skein::test::kPatience)) watched.handle(event, ended);
  return ended.size();
}

}  // namespace

TEST_CASE("the action of an address at which nobody listens is due at once", "[R27]") {
  Epoll epoll;
  WatchedProcesses watched(epoll);
  const std::string address = Other().address;
  int ended = 0;
  WatchedProcesses::Action action = [&] { ++ended; };
  CHECK(watched.watch(address, &kOne, action));
  CHECK(ended == 0);
  REQUIRE(action);
  CHECK(watched.count() == 0);
}

TEST_CASE("the actions of all watchers are due when a process that has greeted hangs up", "[R27]") {
  Epoll epoll;
  WatchedProcesses watched(epoll);
  const Other other;
  CHECK_FALSE(watch(watched, other.address, &kOne));
  CHECK_FALSE(watch(watched, other.address, &kTwo));
  FileDescriptor end = other.accept();
  REQUIRE(send(end.get(), "!", 1, MSG_NOSIGNAL) == 1);
  CHECK(handle(epoll, watched) == 0);
  end.reset();
  CHECK(handle(epoll, watched) == 2);
  CHECK(watched.count() == 0);
  CHECK(epoll.wait(0ms).empty());
}

TEST_CASE("a process that does not greet is tried once more", "[R27]") {
  Epoll epoll;
  WatchedProcesses watched(epoll);
  std::optional<Other> other(std::in_place);
  CHECK_FALSE(watch(watched, other->address, &kOne));
  { const FileDescriptor turned_away = other->accept(); }
  CHECK(handle(epoll, watched) == 0);
  CHECK(watched.count() == 1);
  SECTION("and is not watched if it turns this one away again") {
    { const FileDescriptor turned_away = other->accept(); }
    CHECK(handle(epoll, watched) == 0);
  }
  SECTION("and has ended if nobody listens there any more") {
    other.reset();
    CHECK(handle(epoll, watched) == 1);
  }
  CHECK(watched.count() == 0);
  CHECK(epoll.wait(0ms).empty());
}
