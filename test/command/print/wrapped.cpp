// How lines become those of a terminal.
#include "command/print/wrapped.hpp"

#include <catch2/catch.hpp>

using skein::command::folded;

TEST_CASE("lines longer than the terminal are broken at blanks, and go on indented") {
  CHECK(folded("one two three\n", 9) == "one two\n    three\n");
  CHECK(folded("  one two three four", 12) == "  one two\n      three\n      four");
  CHECK(folded("12:30  sent\nshort\n", 40) == "12:30  sent\nshort\n");
}

TEST_CASE("a word that is longer than the terminal stays whole") {
  CHECK(folded("abcdefghij klm", 5) == "abcdefghij\n    klm");
  CHECK(folded("abcdefghijklm", 5) == "abcdefghijklm");
  CHECK(folded("a abcdefghijklm b", 5) == "a\n    abcdefghijklm\n    b");
}

TEST_CASE("what goes to no terminal is as long as it is") {
  CHECK(folded("one two three\n", 0) == "one two three\n");
}
