#include <catch2/catch.hpp>

#include "idl/types/description_limits.hpp"
#include "idl/types/dynamic_type.hpp"
#include "planner.idl.hpp"
#include "skein/describe.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::types;

TEST_CASE("an interface is described with all that it names, and printed as IDL") {
  const TypeSystem known = describe(test_planner::IPlanner::interface_info());
  CHECK(std::ranges::count(known.declarations, "test_planner::Problem", &Declaration::name) == 1);
  const std::string idl = to_idl(known);
  CHECK_THAT(idl, Catch::Contains("interface IPlanner") && Catch::Contains("exception NoRoute") &&
                      Catch::Contains("struct Problem"));
}

TEST_CASE("a description that makes no sense is refused, and nothing of it is written") {
  Declaration declaration;
  declaration.name = "A::S";
  declaration.modules = 1;
  declaration.members = {{"x", Type{Kind::Long, 0, {}, {}}, {}, 0, {}, {}}};
  const auto refused = [&](const std::string& why) {
    CHECK_THROWS_WITH(to_idl({{declaration}, {}}), Catch::Contains(why));
  };
  CHECK(to_idl({{declaration}, {}}) == "module A {\n@final struct S {\n  long x;\n};\n};\n");

  SECTION("a name that is none") {
    declaration.members[0].name = "x; }; struct Y { long z";
    refused("is no identifier of IDL");
  }
  SECTION("a type that is not there") {
    declaration.members[0].type = {Kind::Declared, 0, "A::T", {}};
    refused("the type 'A::T' is named, but not declared");
  }
  SECTION("a sequence of nothing") {
    declaration.members[0].type.kind = Kind::Sequence;
    refused("a description lacks what its kind has");
  }
  SECTION("a union without discriminator") {
    declaration.kind = DeclarationKind::Union;
    refused("a description lacks what its kind has");
  }
  SECTION("a constant that is none") {
    declaration.members[0].initial = "1) long y; //";
    refused("is no constant of IDL");
  }
  SECTION("a constant that would drive a terminal") {
    declaration.members[0].initial =
        GENERATE("\"\x1b[31m\"", "\"a\nb\"", "\"\x9b\"", "\"\u202e\"", "1\x07");
    refused("is no constant of IDL");
  }
  SECTION("a constant in any language is one") {
    declaration.members[0].type.kind = Kind::String;
    declaration.members[0].initial = "\"Höhe (m); 高度\"";
    CHECK_THAT(to_idl({{declaration}, {}}), Catch::Contains("@default(\"Höhe (m); 高度\")"));
  }
  SECTION("more modules than its name has parts") {
    declaration.modules = 4'000'000'000;
    CHECK_NOTHROW(to_idl({{declaration}, {}}));
  }
}

TEST_CASE("types that make no sense are refused before a value is read by them") {
  Declaration colour;
  colour.name = "A::Colour";
  colour.modules = 1;
  colour.kind = DeclarationKind::Enumeration;
  colour.bits = 32;
  colour.values = {{"RED", 0}, {"BLUE", 1}};
  Declaration either;
  either.name = "A::Either";
  either.modules = 1;
  either.kind = DeclarationKind::Union;
  either.discriminator = {Type{Kind::Declared, 0, "A::Colour", {}}};
  either.members = {{"x", Type{Kind::Long, 0, {}, {}}, {}, 0, {}, {0}}};
  const auto refused = [&](const std::string& why) {
    CHECK_THROWS_WITH(idl::DynamicTypes({{colour, either}, {}}), Catch::Contains(why));
  };
  CHECK(idl::DynamicTypes({{colour, either}, {}}).type("A::Either").members.size() == 1);

  SECTION("a label that is no enumerator") {
    either.members[0].labels = {99};
    refused("a label that is no value of its discriminator");
  }
  SECTION("a map whose key is a struct, or a sequence") {
    const Type number{Kind::Long, 0, {}, {}};
    const Type key = GENERATE(Type{Kind::Declared, 0, "A::Either", {}},
                              Type{Kind::Sequence, 0, {}, {Type{Kind::Long, 0, {}, {}}}});
    either.members[0].type = {Kind::Map, 0, {}, {key, number}};
    refused("its key is of no kind that can be one");
  }
  SECTION("an enumeration of nothing") {
    colour.values.clear();
    refused("an enumeration of nothing");
  }
  SECTION("a name that is not declared") {
    colour.name = "A::Color";
    refused("'A::Colour' makes no sense: it is named, but not declared");
  }
}

TEST_CASE("types may name each other in a long row; more than can be followed are refused") {
  const auto row = [](std::size_t count, unsigned nested = 0) {
    TypeSystem types;
    for (std::size_t i = 0; i < count; ++i) {
      Declaration each;
      each.name = "S" + std::to_string(i);
      Type next = i + 1 < count ? Type{Kind::Declared, 0, "S" + std::to_string(i + 1), {}}
                                : Type{Kind::Long, 0, {}, {}};
      for (unsigned level = 0; level < nested; ++level) {
        next = Type{Kind::Array, 1, {}, {std::move(next)}};
      }
      each.members = {{"x", next, {}, 0, {}, {}}};
      types.declarations.push_back(each);
    }
    return types;
  };
  const TypeSystem most = row(1024);
  CHECK_NOTHROW(idl::check_limits(most));
  CHECK_THAT(to_idl(most), Catch::Contains("struct S0 {\n  S1 x;"));
  CHECK(idl::DynamicTypes(most).type("S0").members.size() == 1);
  CHECK_NOTHROW(to_idl(row(1024, 16)));
  CHECK_NOTHROW(idl::DynamicTypes(row(1024, 16)));
  CHECK_THROWS_WITH(idl::check_limits(row(1, 17)), Catch::Contains("'S0'"));
  CHECK_THROWS_WITH(idl::check_limits(row(1025)), Catch::Contains("1025 types"));
  CHECK_THROWS_WITH(idl::DynamicTypes(row(100'000)), Catch::Contains("100000 types"));
}

TEST_CASE("a name with more parts than scopes can nest is refused") {
  TypeSystem types;
  types.declarations.emplace_back();
  std::string name = "S";
  for (int i = 1; i < 32; ++i) name = "M::" + name;
  types.declarations[0].name = name;
  CHECK_NOTHROW(idl::check_limits(types));
  types.declarations[0].name = "M::" + name;
  CHECK_THROWS_WITH(idl::check_limits(types), Catch::Contains("too many parts"));
}
