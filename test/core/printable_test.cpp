#include "core/printable.hpp"

#include <catch2/catch.hpp>

using skein::printable;

TEST_CASE("text without control characters is shown as it is") {
  for (const char* text :
       {"", "uav-1/navigator", "Höhe 30 µs – “ruhig” 漢 🛩", "a\tb", "a\\x1b"}) {
    CHECK(printable(text) == text);
  }
}

TEST_CASE("what drives a terminal is shown, not sent") {
  CHECK(printable("\x1b[2J\r\n\x7f") == "\\x1b[2J\\x0d\\x0a\\x7f");
  CHECK(printable(std::string_view("a\0b", 3)) == "a\\x00b");
  CHECK(printable("\xc2\x9b"
                  "31m") == "\\xc2\\x9b31m");  // CSI as a C1 character
  CHECK(printable("a\xe2\x80\xae"
                  "b") ==
        "a\\xe2\\x80\\xae"
        "b");  // writes from right to left
  CHECK(printable("a\xe2\x80\xa8"
                  "b") ==
        "a\\xe2\\x80\\xa8"
        "b");  // a line separator
}

TEST_CASE("bytes that are no UTF-8 are shown one by one") {
  CHECK(printable("\x9b") == "\\x9b");
  CHECK(printable("\xc0\x80") == "\\xc0\\x80");                    // longer than it need be
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");           // half of a pair
  CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // beyond Unicode
  CHECK(printable("ab\xe2\x82") == "ab\\xe2\\x82");                // cut off
  CHECK(printable("\xffz") == "\\xffz");
}

TEST_CASE("of a long text the beginning is shown, and its size") {
  CHECK(printable("abcdef", 6) == "abcdef");
  CHECK(printable("abcdefg", 6) == "abcdef... (7 bytes)");
  CHECK(printable("ab\xc3\xa4", 3) == "ab... (4 bytes)");  // never half a character
  CHECK(printable(std::string(1 << 20, '\x1b')).size() < 4 * skein::kLongestShownName + 30);
}
