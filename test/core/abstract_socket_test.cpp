#include "core/system/abstract_socket.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <list>
#include <string>
#include <thread>
#include <vector>

#include "core/system/bound_sockets.hpp"
#include "core/system/close_elsewhere.hpp"
#include "core/system/other_process.hpp"
#include "core/system/trusted_users.hpp"
#include "skein/guid.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/lingering_connection.hpp"

using namespace skein;
using skein::test::eventually;
using skein::test::LingeringConnection;
using skein::test::returns_at_once;

namespace {

const auto kEverybody = [](uid_t) { return true; };

bool hung_up(const FileDescriptor& socket) {
  pollfd look{socket.get(), POLLRDHUP, 0};
  return eventually([&] { return poll(&look, 1, 0) == 1; });
}

}  // namespace

TEST_CASE("who turns a client away does not wait for what it handed over") {
  const std::string name = "skein-test/" + Guid::random().hex();
  const ListeningSocket listening(local_socket());
  REQUIRE(listen_at(listening, name));
  LingeringConnection lingering;
  const Contact client = reach(name, kEverybody);
  REQUIRE(lingering.hand_over(client.socket.get()));
  int seen = 0;
  CHECK(returns_at_once(
      [&] { let_in(listening.get(), kAcceptedInARow, [&](const FileDescriptor&) { ++seen; }); }));
  CHECK(seen == 1);
  CHECK(hung_up(client.socket));
  lingering.release();
}

TEST_CASE("who finds a stranger at a name does not wait for what it handed over") {
  const std::string name = "skein-test/" + Guid::random().hex();
  const FileDescriptor listening(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  REQUIRE(listen_at(listening, name));
  LingeringConnection lingering;
  std::thread stranger([&] {
    const FileDescriptor accepted(::accept(listening.get(), nullptr, nullptr));
    lingering.hand_over(accepted.get());
  });
  const auto knows_late = [&](uid_t) {
    stranger.join();
    return false;
  };
  Contact contact;
  CHECK(returns_at_once([&] { contact = reach(name, knows_late); }));
  CHECK(contact.reached == Reached::Stranger);
  CHECK_FALSE(contact.socket);
  lingering.release();
}

TEST_CASE("who listens no more does not wait for those who wait there, and its name is free") {
  const std::string name = "skein-test/" + Guid::random().hex();
  ListeningSocket listening(local_socket());
  REQUIRE(listen_at(listening, name));
  LingeringConnection lingering;
  const Contact client = reach(name, kEverybody);
  REQUIRE(lingering.hand_over(client.socket.get()));
  CHECK(returns_at_once([&] { listening.close(); }));
  CHECK(hung_up(client.socket));
  CHECK(reach(name, kEverybody).reached == Reached::Nobody);
  CHECK(listen_at(local_socket(), name));
  lingering.release();
}

TEST_CASE("nobody is let in while too much is left to be closed") {
  const std::string name = "skein-test/" + Guid::random().hex();
  const ListeningSocket listening(local_socket());
  REQUIRE(listen_at(listening, name));
  std::list<LingeringConnection> lingering;
  CHECK(returns_at_once([&] {
    while (!closing_is_behind()) close_elsewhere(lingering.emplace_back().take());
  }));
  CHECK(lingering.size() < 100);
  const Contact client = reach(name, kEverybody);
  int seen = 0;
  const auto let_one_in = [&] {
    return let_in(listening.get(), 1, [&](const FileDescriptor&) { ++seen; });
  };
  CHECK_FALSE(let_one_in());
  CHECK(seen == 0);
  for (auto& each : lingering) each.release();
  CHECK(eventually([&] { return let_one_in() && seen == 1; }));
}

TEST_CASE("another process is known by its socket, not by its number alone") {
  const std::string name = "skein-test/" + Guid::random().hex();
  const ListeningSocket listening(local_socket());
  REQUIRE(listen_at(listening, name));
  const Contact client = reach(name, is_own_user);
  REQUIRE(client.reached == Reached::Yes);
  CHECK(client.process == getpid());
  CHECK_FALSE(has_ended(other_process(client.socket).descriptor));
  const auto sockets = bound_sockets();
  REQUIRE(sockets.contains(name));
  const auto held_by = [&](pid_t process) {
    return std::ranges::count(open_in(process), sockets.at(name)) > 0;
  };
  CHECK(held_by(getpid()));
  CHECK_FALSE(held_by(getppid()));
}

TEST_CASE("the number by which the kernel shows users that are not mapped is no user's") {
  CHECK(is_unmapped(65'534));
  CHECK(is_own_user(geteuid()) != is_unmapped(geteuid()));
  CHECK_FALSE(is_own_user(geteuid() + 1));
}
