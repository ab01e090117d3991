#include "core/system/interface_name.hpp"

#include <catch2/catch.hpp>

#include "skein/error.hpp"

using namespace skein;

TEST_CASE("Every spelling of an interface's name has one canonical form") {
  const std::string canonical = "AE_navigator/IPlanner";
  for (const char* spelling :
       {"IDL:AE_navigator/IPlanner", "IDL:AE_navigator/IPlanner:1.0", "AE_navigator/IPlanner",
        "AE_navigator::IPlanner", "::AE_navigator::IPlanner", "  IDL:AE_navigator/IPlanner\n  "}) {
    CAPTURE(spelling);
    CHECK(canonical_interface_name(spelling) == canonical);
    CHECK(same_interface(spelling, canonical));
    CHECK(short_interface_name(spelling) == "IPlanner");
    CHECK(scoped_interface_name(spelling) == "AE_navigator::IPlanner");
  }
}

TEST_CASE("An interface without a module has a canonical form, too") {
  CHECK(canonical_interface_name("IPlanner") == "IPlanner");
  CHECK(same_interface("IDL:IPlanner:2.1", "::IPlanner"));
}

TEST_CASE("Interfaces of different modules are different") {
  CHECK_FALSE(same_interface("AE_navigator/IPlanner", "AE_pilot/IPlanner"));
  CHECK_FALSE(same_interface("AE_navigator/IPlanner", "IPlanner"));
}

TEST_CASE("What is no interface name is refused with a remedy") {
  for (const char* text : {"", "  ", "IDL:", "::", "a b", "1a/b", "a//b", "a::", "a/b::c", "a:b",
                           "IDL:a/b:1", "IDL:a/b:x.y", "a/\xC3\xA4"}) {
    CAPTURE(text);
    CHECK_FALSE(is_interface_name(text));
    CHECK_THROWS_WITH(canonical_interface_name(text), Catch::Contains("AE_navigator::IPlanner"));
    CHECK_THROWS_AS(canonical_interface_name(text), InvalidArgument);
  }
}
