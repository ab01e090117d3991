#include "dds/port/type_version.hpp"

#include <catch2/catch.hpp>

#include "dds/port/compatibility.hpp"

using namespace skein;
using namespace skein::dds;

namespace {

/// A version with so many members; the last one must be understood.
Qos version_of(std::uint32_t members) {
  Qos qos;
  qos.type.signature = 7;
  for (std::uint32_t i = 0; i < members; ++i) {
    qos.type.members.push_back({1, i, 100 + i, i + 1 == members, "A::S.m"});
  }
  return qos;
}

/// As discovery brings it.
Qos carried(const Qos& qos) {
  Qos result = qos;
  result.type = from_user_data(to_user_data(qos.type));
  return result;
}

bool match(const Qos& one, const Qos& other) {
  return !find_incompatibility("t", {}, one, other) && !find_incompatibility("t", {}, other, one);
}

}  // namespace

TEST_CASE("a version is carried by discovery and compared on the other side") {
  CHECK(match(version_of(3), carried(version_of(3))));
  CHECK_FALSE(match(version_of(3), carried(version_of(4))));  // the fourth must be understood
  CHECK(match(version_of(3), Qos{}));                         // whose peer tells none
  Qos another = version_of(3);
  another.type.members[1].digest = 9;
  const auto why = find_incompatibility("t", {}, another, carried(version_of(3)));
  REQUIRE(why);
  CHECK(why->policy == "type");
  CHECK(why->offered == "A::S.m in version 00000009");
  CHECK(why->requested == "A::S.m in version 00000065");
}

TEST_CASE("two types of one name are told apart by the first member that differs") {
  const auto told = [](const std::string& offered, const std::string& requested) {
    Qos one, other;
    one.type = {1, {}, offered};
    other.type = {2, {}, requested};
    const auto why = find_incompatibility("t", {}, one, carried(other));
    REQUIRE(why);
    return why->offered + " | " + why->requested;
  };
  const std::string head = "module sea {\n@final struct Fix {\ndouble x_m;\n";
  const std::string end = "};\n};\n";
  CHECK(told(head + "double y_m;\n" + end, head + "float y_m;\n" + end) ==
        "sea::Fix with 'double y_m' | sea::Fix with 'float y_m'");
  CHECK(told(head + "double y_m;\n" + end, head + end) ==
        "sea::Fix with 'double y_m' | sea::Fix without a further member");
  CHECK(told("@final struct Fix {\n};\n", "@final union Fix switch (long) {\n};\n") ==
        "@final struct Fix { | @final union Fix switch (long) {");
  CHECK(told("", head + end) == "version 0000000000000001 | version 0000000000000002");
  CHECK(told(head, "module sea {\n@final struct Fix {\n\x1b[31m;\n") ==
        "sea::Fix with 'double x_m' | sea::Fix with '\\x1b[31m'");
}

TEST_CASE("of a long text discovery carries whole lines, and what lies behind is not told") {
  Qos qos = version_of(10);
  for (int i = 0; i < 500; ++i) qos.type.text += "member " + std::to_string(i) + "\n";
  CHECK(to_user_data(qos.type).size() <= 2000);
  const std::string text = carried(qos).type.text;
  CHECK(text.size() > 1500);
  CHECK(text.ends_with('\n'));
  CHECK(qos.type.text.starts_with(text));
}

TEST_CASE("members that discovery does not carry are not compared") {
  CHECK(to_user_data(version_of(500).type).size() < 2048);
  CHECK(match(version_of(130), carried(version_of(130))));
  CHECK(match(version_of(130), carried(version_of(500))));
  Qos another = version_of(130);
  another.type.members[100].digest = 9;
  CHECK_FALSE(match(another, carried(version_of(130))));
}

TEST_CASE("a member behind the end of the other side's list is not missing there") {
  Qos many = version_of(130);
  Qos few = version_of(130);
  few.type.members.resize(2);
  for (Qos* qos : {&few, &many}) qos->type.members.push_back({2, 0, 1, true, "A::T.m"});
  CHECK(match(few, carried(many)));
  CHECK(match(many, carried(few)));
}

TEST_CASE("user data of others, or broken one, tells no version") {
  auto data = to_user_data(version_of(3).type);
  CHECK(from_user_data(data).members.size() == 3);
  data.pop_back();
  CHECK(from_user_data(data).signature == 0);
  data[0] = 'X';
  CHECK(from_user_data(data).signature == 0);
  CHECK(from_user_data({}).signature == 0);
}
