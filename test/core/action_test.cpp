#include "skein/detail/action.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <memory>

#include "skein/detail/call_memory.hpp"

using skein::Action;

namespace {

/// An action of that size which holds `token`, and counts how often it has run.
template <std::size_t Size>
auto made(std::shared_ptr<int> token) {
  return [token = std::move(token), room = std::array<char, Size>{}] { *token += 1 + room[0]; };
}

template <std::size_t Size>
void runs_moves_and_ends() {
  const auto token = std::make_shared<int>(0);
  {
    Action action = made<Size>(token);
    CHECK(token.use_count() == 2);
    action();
    Action moved = std::move(action);
    CHECK_FALSE(action);
    moved();
    action = std::move(moved);
    action();
    CHECK(token.use_count() == 2);
    action = nullptr;
    CHECK(token.use_count() == 1);
    action = made<Size>(token);
  }
  CHECK(*token == 3);
  CHECK(token.use_count() == 1);
}

}  // namespace

TEST_CASE("an action runs what it holds, wherever it is moved, and lets it go once") {
  SECTION("in place") { runs_moves_and_ends<8>(); }
  SECTION("on the heap") { runs_moves_and_ends<100>(); }
}

TEST_CASE("an action may hold what cannot be copied") {
  int seen = 0;
  Action action = [value = std::make_unique<int>(7), &seen] { seen = *value; };
  action();
  CHECK(seen == 7);
}

#ifndef __SANITIZE_ADDRESS__  // under which nothing is kept
TEST_CASE("what a call gives back is handed out again, to what is of its size") {
  auto& memory = skein::call_memory();
  void* const first = memory.allocate(100);
  memory.deallocate(first, 100);
  void* const other = memory.allocate(300);
  void* const again = memory.allocate(120);
  CHECK(again == first);
  CHECK(other != first);
  memory.deallocate(again, 120);
  memory.deallocate(other, 300);
}
#endif
