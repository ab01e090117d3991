#include "recording/viewers/recording_idl.hpp"

#include <catch2/catch.hpp>

#include "skein/error.hpp"

using namespace skein;
using namespace skein::types;
using recording::to_recording_idl;

namespace {

Type type(Kind kind, std::vector<Type> elements = {}) { return {kind, 0, {}, std::move(elements)}; }
Type declared_type(const std::string& name) { return {Kind::Declared, 0, name, {}}; }

Member member(const std::string& name, Type its_type) {
  Member member;
  member.name = name;
  member.type = std::move(its_type);
  return member;
}

Declaration structure(const std::string& name, std::uint32_t modules, std::vector<Member> members,
                      Extensibility extensibility = Extensibility::Final) {
  Declaration declaration;
  declaration.name = name;
  declaration.modules = modules;
  declaration.extensibility = extensibility;
  declaration.members = std::move(members);
  return declaration;
}

}  // namespace

TEST_CASE("a plain struct is itself, in its module") {
  const auto idl = to_recording_idl(
      {{structure("A::S", 1, {member("x", type(Kind::Long)), member("text", type(Kind::String))})},
       {}},
      "A::S");
  CHECK(idl.type == "A::S");
  CHECK(idl.text == "module A {\n@final struct S {\n  long x;\n  string text;\n};\n};\n");
}

TEST_CASE("a type inside an interface or a struct stands in the module") {
  const auto idl =
      to_recording_idl({{structure("A::I::S", 1, {member("x", declared_type("A::I::S::T"))}),
                         structure("A::I::S::T", 1, {})},
                        {}},
                       "A::I::S");
  CHECK(idl.type == "A::I_S");
  CHECK_THAT(idl.text, Catch::Contains("struct I_S {\n  A::I_S_T x;\n}"));
}

TEST_CASE("names that are words of viewers' parsers get an underscore") {
  const auto idl = to_recording_idl(
      {{structure("A::string", 1,
                  {member("byte", type(Kind::Octet)), member("long", type(Kind::Long))})},
       {}},
      "A::string");
  CHECK(idl.type == "A::string_");
  CHECK_THAT(idl.text, Catch::Contains("octet _byte;") && Catch::Contains("long _long;"));
}

TEST_CASE("a type that contains itself by a sequence has no schema, and the reason is said") {
  const TypeSystem types{
      {structure("Tree", 0, {member("children", type(Kind::Sequence, {declared_type("Tree")}))}),
       structure("Park", 0, {member("tree", declared_type("Tree"))})},
      {}};
  CHECK_THROWS_WITH(to_recording_idl(types, "Park"),
                    Catch::Contains("contains itself by a sequence"));
}

TEST_CASE("descriptions that make no sense are refused") {
  CHECK_THROWS_WITH(to_recording_idl({}, "S"), Catch::Contains("no type 'S' is described"));
  CHECK_THROWS_WITH(
      to_recording_idl({{structure("S", 0, {member("x", type(Kind::Sequence))})}, {}}, "S"),
      Catch::Contains("lacks what its kind has"));
  CHECK_THROWS_WITH(
      to_recording_idl({{structure("S", 0, {member("x; } //", type(Kind::Long))})}, {}}, "S"),
      Catch::Contains("is no identifier"));
  Declaration enumeration;
  enumeration.name = "E";
  enumeration.kind = DeclarationKind::Enumeration;
  enumeration.bits = 32;
  enumeration.values = {{"A", 0}};
  CHECK_THROWS_WITH(to_recording_idl({{enumeration}, {}}, "E"), Catch::Contains("is no message"));
}
