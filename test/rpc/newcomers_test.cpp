#include "rpc/server/newcomers.hpp"

#include <catch2/catch.hpp>

using namespace skein;
using rpc::Newcomer;
using rpc::Newcomers;

namespace {

Newcomer client(std::uint8_t peer, std::uint8_t number, bool opens = true) {
  Newcomer newcomer;
  newcomer.id.client.bytes[0] = peer;
  newcomer.id.client.bytes[15] = number;
  newcomer.opens = opens;
  return newcomer;
}

std::string drain(Newcomers& newcomers) {
  std::string order;
  while (const auto next = newcomers.pop()) {
    order += static_cast<char>('a' + next->id.client.bytes[0]);
    order += static_cast<char>('0' + next->id.client.bytes[15]);
  }
  return order;
}

}  // namespace

TEST_CASE("peers take turns, and each keeps its order") {
  Newcomers newcomers;
  for (std::uint8_t i = 0; i < 3; ++i) REQUIRE(newcomers.push(client(0, i)));
  REQUIRE(newcomers.push(client(1, 0)));
  CHECK(drain(newcomers) == "a0b0a1a2");
  CHECK(newcomers.empty());
}

TEST_CASE("a client that asks again before its turn waits once, and opens if it ever asked to") {
  Newcomers newcomers;
  CHECK(newcomers.push(client(0, 0, false)));
  CHECK(newcomers.push(client(0, 0, true)));
  CHECK(newcomers.push(client(0, 0, false)));
  CHECK(newcomers.pop()->opens);
  CHECK_FALSE(newcomers.pop());
}

TEST_CASE("a client that left keeps its place, and is as new if it comes back") {
  Newcomers newcomers;
  CHECK(newcomers.push(client(0, 0, true)));
  CHECK(newcomers.push(client(0, 1, true)));
  newcomers.note_left(client(0, 0).id.client);
  newcomers.note_left(client(0, 1).id.client);
  newcomers.note_left(client(0, 2).id.client);
  CHECK(newcomers.push(client(0, 1, false)));
  CHECK(newcomers.pop()->left);
  const auto back = newcomers.pop();
  CHECK_FALSE(back->left);
  CHECK_FALSE(back->opens);
  CHECK_FALSE(newcomers.pop());
}

TEST_CASE("a peer with thousands of clients has its room, and others have theirs") {
  Newcomers newcomers;
  std::size_t taken = 0;
  for (std::uint8_t i = 0; i < 255; ++i) taken += newcomers.push(client(0, i)) ? 1 : 0;
  CHECK(taken == Newcomers::kRoomOfPeer);
  CHECK(newcomers.push(client(1, 0)));
}

TEST_CASE("many peers together have bounded room, and there is some for one more") {
  Newcomers newcomers;
  std::size_t taken = 0;
  for (std::uint8_t peer = 0; peer < 20; ++peer) {
    std::size_t of_peer = 0;
    for (std::uint8_t i = 0; i < 255; ++i) of_peer += newcomers.push(client(peer, i)) ? 1 : 0;
    CHECK(of_peer > 0);
    taken += of_peer;
  }
  CHECK(taken <= Newcomers::kRoom);
}
