#include "buoy.idl.h"
#include "harbour.hpp"
#include "languages/c/struct_value.hpp"

using namespace skein;
using namespace skein::test;

namespace {

harbour::Cargo cargo() {
  harbour::Cargo inner;
  inner.name = L"inner";
  inner.names = {"a", ""};
  harbour::Cargo cargo;
  cargo.name = L"Größe \u20AC";
  cargo.dangers = harbour::Dangers::fire | harbour::Dangers::poison;
  cargo.seal.number = 9;
  cargo.sides = {{{1, 2, 3}, {4, 5, 6}}};
  cargo.shelves = {{1, 2}, {}, {3}};
  cargo.winds = {{"north", {1, 2.5, harbour::Side::Starboard}}, {"south", {}}};
  cargo.content.emplace().winds({{7, 8.5, harbour::Side::Port}});
  cargo.inner = {inner, {}};
  cargo.mark = 'x';
  cargo.letter = L'\u20AC';
  cargo.fragile = true;
  cargo.exact = 0.1L;
  return cargo;
}

struct Types {
  Types() { REQUIRE(buoy_types(&interface, error)); }
  ~Types() { skein_interface_free(interface, {}); }

  skein_result converted(const skein_value& value, skein_encoding encoding) {
    skein_result result{};
    if (!skein_interface_convert(interface, harbour_Cargo_TYPE, value, encoding, &result, error)) {
      FAIL(error.text());
    }
    return result;
  }

  CError error;
  skein_interface interface {};
};

}  // namespace

TEST_CASE_METHOD(Types, "a C struct has what the value has, and becomes the same CDR and JSON") {
  const Bytes cdr = idl::encode_message(cargo());
  const skein_result lent = converted(cdr_of(cdr), SKEIN_STRUCT);
  skein_value value{};
  REQUIRE(skein_result_value(lent, &value, error));
  REQUIRE(value.size == sizeof(harbour_Cargo));
  const auto& c = *static_cast<const harbour_Cargo*>(value.data);
  CHECK(std::string(c.name) == "Größe \u20AC");
  CHECK(c.dangers == (harbour_Dangers_fire | harbour_Dangers_poison));
  CHECK((c.seal >> harbour_Seal_number_SHIFT & harbour_Seal_number_MASK) == 9);
  CHECK(c.sides[1][2] == 6);
  REQUIRE(c.shelves.size == 3);
  CHECK(c.shelves.data[0].data[1] == 2);
  REQUIRE(c.winds.size == 2);
  CHECK(std::string(c.winds.data[0].key) == "north");
  CHECK(c.winds.data[0].value.speed_m_s == 2.5);
  REQUIRE(c.content);
  CHECK(c.content->d == harbour_Crane_Large);
  CHECK(c.content->u.winds.data[0].force == 7);
  REQUIRE(c.inner.size == 2);
  CHECK(std::string(c.inner.data[0].names.data[0]) == "a");
  CHECK(c.letter == 0x20AC);
  CHECK(c.exact == 0.1L);
  CHECK_FALSE(c.depth);

  CHECK(taken(converted(value, SKEIN_CDR)) ==
        std::string(reinterpret_cast<const char*>(cdr.data()), cdr.size()));
  CHECK(taken(converted(value, SKEIN_JSON)) == idl::to_json(cargo()));
  CHECK(skein_result_free(lent, error));
}

TEST_CASE_METHOD(Types, "a struct that is another one, or incomplete, is refused with the place") {
  harbour_Cargo c{};
  skein_result result{};
  const auto refused = [&](std::size_t size) {
    CHECK_FALSE(skein_interface_convert(interface, harbour_Cargo_TYPE, skein_struct(&c, size),
                                        SKEIN_CDR, &result, error));
    return error.text();
  };
  CHECK_THAT(refused(8), Catch::Contains("has 8 bytes, and should have " +
                                         std::to_string(sizeof(harbour_Cargo))));
  c.shelves.size = 2;
  CHECK_THAT(refused(sizeof c), Catch::Contains("harbour::Cargo.shelves has 2 elements at NULL"));
  c.shelves.size = 0;
  const harbour_Depth depth{nullptr, 3};
  c.depth = &depth;
  CHECK(taken(converted(skein_struct(&c, sizeof c), SKEIN_JSON))
            .find(R"("depth":{"place":"","depth_m":3})") != std::string::npos);
  CHECK_FALSE(skein_interface_convert(interface, "harbour::Cargoo", skein_json("{}"), SKEIN_CDR,
                                      &result, error));
  CHECK_THAT(error.text(), Catch::Contains("did you mean 'harbour::Cargo'"));
}

TEST_CASE("a type that a peer describes as its own part is refused, not followed for ever") {
  // As JSON, since no IDL compiler accepts it.
  types::TypeSystem endless;
  types::Member self;
  self.name = "self";
  self.type.kind = types::Kind::Declared;
  self.type.name = "A";
  types::Declaration declaration;
  declaration.name = "A";
  declaration.members = {self};
  endless.declarations = {declaration};
  const idl::DynamicTypes types(endless);
  CHECK_THROWS_WITH(c::struct_size(types.type("A")), Catch::Contains("contains itself"));
}
