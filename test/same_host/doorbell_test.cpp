#include "same_host/doorbell.hpp"

#include <fcntl.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <limits>
#include <optional>
#include <thread>
#include <vector>

#include "core/system/abstract_socket.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

using Ids = std::vector<std::uint64_t>;

Ids wait(Doorbells& doorbells, std::optional<std::chrono::milliseconds> longest = {}) {
  const auto rung = doorbells.wait(longest);
  return {rung.begin(), rung.end()};
}

}  // namespace

TEST_CASE("a doorbell wakes the thread that sleeps, and says whose it is") {
  Doorbells doorbells;
  const FileDescriptor one = make_doorbell(), other = make_doorbell();
  doorbells.add(one, 1);
  doorbells.add(other, 2);
  wait(doorbells, 0ms);
  std::atomic<int> rung{0};
  std::thread sleeper([&] {
    while (rung != 2) {
      for (const std::uint64_t id : doorbells.wait()) rung = int(id);
    }
  });
  ring(one);
  CHECK(eventually([&] { return rung == 1; }));
  ring(other);
  sleeper.join();
}

TEST_CASE("each ring is told of once, also one that came before the wait") {
  Doorbells doorbells;
  const FileDescriptor one = make_doorbell(), other = make_doorbell();
  doorbells.add(one, 1);
  doorbells.add(other, 2);
  CHECK(wait(doorbells, 0ms) == Ids{1, 2});  // they may have rung before
  CHECK(wait(doorbells, 0ms).empty());
  ring(other);
  ring(one);
  CHECK(wait(doorbells) == Ids{2, 1});
  doorbells.remove(other);
  ring(other);
  CHECK(wait(doorbells, 0ms).empty());
}

TEST_CASE("a call ends the sleep that goes on, and the next one") {
  Doorbells doorbells;
  const FileDescriptor doorbell = make_doorbell();
  doorbells.add(doorbell, 1);
  wait(doorbells, 0ms);
  doorbells.call();
  CHECK(doorbells.called());
  CHECK(wait(doorbells).empty());
  doorbells.forget_call();
  std::atomic<bool> over{false};
  std::thread sleeper([&] {
    while (!over) {
      doorbells.forget_call();
      if (!over) doorbells.wait();
    }
  });
  over = true;
  doorbells.call();
  sleeper.join();
}

TEST_CASE("ringing never waits for the other side, whatever that does to the doorbell") {
  const FileDescriptor doorbell = make_doorbell();
  const FileDescriptor theirs(dup(doorbell.get()));
  REQUIRE(fcntl(theirs.get(), F_SETFL, 0) == 0);
  eventfd_t before = 0;
  REQUIRE(eventfd_read(theirs.get(), &before) == 0);
  REQUIRE(eventfd_write(theirs.get(), std::numeric_limits<eventfd_t>::max() - 1) == 0);
  Doorbells doorbells;
  doorbells.add(doorbell, 1);
  CHECK(wait(doorbells, 0ms) == Ids{1});
  ring(doorbell);
  CHECK(wait(doorbells, 0ms) == Ids{1});
}

TEST_CASE("only an eventfd is a doorbell") {
  int ends[2];
  REQUIRE(pipe2(ends, O_CLOEXEC) == 0);
  const FileDescriptor reads(ends[0]), writes(ends[1]);
  CHECK(is_doorbell(make_doorbell()));
  CHECK_FALSE(is_doorbell(reads));
  CHECK_FALSE(is_doorbell(writes));
  CHECK_FALSE(is_doorbell(local_socket()));
  CHECK_FALSE(is_doorbell(FileDescriptor(epoll_create1(EPOLL_CLOEXEC))));
  CHECK_FALSE(is_doorbell(FileDescriptor(open("/proc/self/stat", O_RDONLY | O_CLOEXEC))));
  CHECK_FALSE(is_doorbell(FileDescriptor()));
}
