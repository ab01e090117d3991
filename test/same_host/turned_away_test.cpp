#include "same_host/turned_away.hpp"

#include <catch2/catch.hpp>

using namespace skein::same_host;

TEST_CASE("the log hears once of each user who is turned away") {
  TurnedAway turned_away;
  for (int i = 0; i < 3; ++i) turned_away.note_stranger({7, 1000, 0});
  turned_away.note_stranger({8, 1001, 0});
  const auto told = turned_away.take();
  REQUIRE(told.size() == 2);
  CHECK_THAT(told[0], Catch::StartsWith("process 7 of user 1000 is turned away"));
  turned_away.note_stranger({9, 1000, 0});
  CHECK(turned_away.take().empty());
}

TEST_CASE("the log hears once of a process that wants more than its share, whichever it is") {
  TurnedAway turned_away;
  turned_away.note_share(7, 2);
  turned_away.note_share(8, 2);
  const auto told = turned_away.take();
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0], Catch::StartsWith("process 7 wants more than its share of 2 connections"));
}
