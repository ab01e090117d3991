#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "codec_check.hpp"
#include "names.idl.hpp"
#include "planner.idl.hpp"
#include "samples.hpp"

namespace everything {

using skein::idl::decode_message;
using skein::idl::encode_message;
using skein::idl::from_json;
using skein::idl::to_json;

namespace {

/// The text of the error that `action` throws.
template <class Error, class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace

TEST_CASE("every kind of type survives CDR, JSON and copying through its type support") {
  check_round_trips(samples::basic());
  check_round_trips(samples::compound());
  check_round_trips(samples::choices());
  check_round_trips(samples::tree());
  check_round_trips(Compound());
  check_round_trips(test_planner::NoRoute("fog", 3));
  check_round_trips(test_planner::Busy());
  check_round_trips(test_planner::IPlanner_plan_In{test_planner::Problem{}});
  check_round_trips(test_planner::IPlanner_reset_In{});
  check_round_trips(Colour::Blue);
  check_round_trips(skein::ServiceReference{"A/I", skein::Guid::random(), "main"});
}

TEST_CASE("members have initial values") {
  const Basic basic;
  CHECK(basic.medium == 0);
  CHECK_FALSE(basic.flag);
  CHECK(basic.real == 0);
  CHECK(basic.colour == Colour::Red);
  CHECK(Compound().matrix == Matrix{});
}

TEST_CASE("constants have the values of the IDL") {
  STATIC_REQUIRE(kMinusOne == -1);
  STATIC_REQUIRE(kLargest == std::numeric_limits<std::uint64_t>::max());
  STATIC_REQUIRE(kSmallest == -std::numeric_limits<std::int64_t>::max());
  STATIC_REQUIRE(kHalf == 0.5);
  STATIC_REQUIRE(kQuarter == 0.25F);
  STATIC_REQUIRE(kYes);
  STATIC_REQUIRE(kNewline == '\n');
  STATIC_REQUIRE(kLatin == '\xe9');
  STATIC_REQUIRE(kUtf8 == "5 µm → 0");
  STATIC_REQUIRE(kOctet == 255);
  STATIC_REQUIRE(kQuoted == "a \"quoted\" \\ text");
  STATIC_REQUIRE(kFavourite == Colour::Green);
  STATIC_REQUIRE(test_planner::IPlanner::kDefaultMargin == 2.5);
}

TEST_CASE("values print readably") {
  CHECK(to_string(Colour::Green) == "Green");
  CHECK(to_string(static_cast<Colour>(7)) == "everything::Colour(7)");
  CHECK(to_string(test_geometry::Position{1, 2.5, -3}) ==
        "Position{east_m=1, north_m=2.5, up_m=-3}");
  CHECK(to_string(samples::tree()) ==
        "Tree{label=\"root\", children=[Tree{label=\"left\", children=[]}, "
        "Tree{label=\"right\", children=[Tree{label=\"leaf\", children=[]}]}]}");
  Shape shape;
  shape.remark("a\n\"b\"");
  CHECK(to_string(shape) == "Shape{Blue, remark=\"a\\n\\\"b\\\"\"}");
  test_planner::Problem problem;
  problem.terrain.resize(1000);
  CHECK(to_string(problem).ends_with("0, ... 1000 elements]}"));
}

TEST_CASE("a union holds the member that its discriminator selects") {
  Shape shape;
  CHECK(shape.discriminator() == Colour::Red);
  CHECK(shape.holds_radius());
  CHECK(shape.radius() == 0);
  shape.radius(2);
  CHECK(error_of<skein::InvalidArgument>([&] { shape.corner(); }) ==
        "everything::Shape does not hold 'corner': its discriminator selects something else");

  shape.remark("none");
  CHECK(shape.discriminator() == Colour::Blue);
  CHECK_FALSE(shape.holds_radius());

  shape.select(Colour::Green);
  CHECK(shape.corner() == test_geometry::Position{});
}

TEST_CASE("a union's member with several labels keeps the one that was set") {
  Number number;
  number.real(1.5);
  CHECK(number.discriminator() == -1);
  number.real(2.5, 1);
  CHECK(number.discriminator() == 1);
  CHECK_THROWS_AS(number.real(2.5, 2), skein::InvalidArgument);
  number.select(-1);
  CHECK(number.real() == 2.5);
  check_round_trips(number);
}

TEST_CASE("a union without a default holds nothing under a discriminator that no case names") {
  Maybe maybe;
  maybe.select(false);
  CHECK_FALSE(maybe.holds_value());
  CHECK(encode_message(maybe).size() == 5);
  check_round_trips(maybe);
}

TEST_CASE("a bound is kept on encoding, on decoding and from JSON") {
  Compound value = samples::compound();
  value.tags.push_back("d");
  CHECK(error_of<skein::InvalidArgument>([&] { encode_message(value); }) ==
        "everything::Compound.tags holds 4 elements, at most 3 are allowed");
  value = samples::compound();
  value.words[1] = "twelve";
  CHECK_THROWS_AS(encode_message(value), skein::InvalidArgument);
  value = samples::compound();
  value.table[0].push_back(3);
  CHECK_THROWS_AS(encode_message(value), skein::InvalidArgument);

  const std::string json = to_json(value);
  CHECK(error_of<skein::InvalidArgument>([&] { from_json<Compound>(json); }) ==
        "JSON: $ does not fit: everything::Compound.table holds 3 elements, at most 2 are allowed");

  Shape shape;
  shape.remark("seven77");
  CHECK_THROWS_AS(encode_message(shape), skein::InvalidArgument);
}

TEST_CASE("text with a zero byte and enumerators that do not exist are not sent") {
  Basic basic = samples::basic();
  basic.text = std::string("a\0b", 3);
  CHECK_THROWS_AS(encode_message(basic), skein::InvalidArgument);
  basic = samples::basic();
  basic.colour = static_cast<Colour>(3);
  CHECK(error_of<skein::InvalidArgument>([&] { encode_message(basic); }) ==
        "3 is no value of the enumeration everything::Colour");
}

TEST_CASE("a type contains itself by an external or an optional member, whose copies are values") {
  recursive::Link first{1, recursive::Link{2, {}}};
  const recursive::Link copy = first;
  (*first.next)->value = 3;
  CHECK(copy == recursive::Link{1, recursive::Link{2, {}}});
  CHECK(copy != first);
  check_round_trips(first);
  CHECK(to_string(first) == "Link{value=1, next=Link{value=3, next=nothing}}");

  recursive::Sum sum;
  CHECK(sum.number() == 0);  // the first member that is no sum again
  CHECK(recursive::Pair() == recursive::Pair{recursive::Sum(), 0});
  sum.pair({recursive::Sum(), 5});
  recursive::Sum around;
  around.sum(sum);
  check_round_trips(around);
  CHECK(around.sum()->pair().right == 5);
}

TEST_CASE("recursive values nest up to a limit, in CDR and in JSON") {
  check_round_trips(samples::chain(skein::idl::kMaximumNesting));
  const recursive::Tree deep = samples::chain(skein::idl::kMaximumNesting + 1);
  CHECK_THROWS_AS(encode_message(deep), skein::InvalidArgument);
  recursive::Expression inner;
  inner.value(1);
  recursive::Expression expression;
  expression.operands({inner, inner});
  check_round_trips(expression);
}

TEST_CASE("JSON carries the numbers that JSON has no form for") {
  Basic basic = samples::basic();
  basic.single = std::numeric_limits<float>::infinity();
  basic.real = std::nan("");
  basic.letter = '\xE9';
  const Basic back = from_json<Basic>(to_json(basic));
  CHECK(back.single == basic.single);
  CHECK(std::isnan(back.real));
  CHECK(back.letter == '\xE9');
}

TEST_CASE("null and empty text refer to no service") {
  CHECK(from_json<skein::ServiceReference>("null").is_nil());
  CHECK(from_json<skein::ServiceReference>("\"\"").is_nil());
  CHECK_THROWS_AS(from_json<skein::ServiceReference>("\"uav\""), skein::InvalidArgument);
}

TEST_CASE("JSON keeps the sign of a zero for readers that take -0 for an integer") {
  CHECK_THAT(to_json(test_planner::Route{.length_m = -0.0}), Catch::Contains(":-0.0"));
}

TEST_CASE("JSON that does not fit is refused with the place") {
  const auto refusal = [](const std::string& json) {
    return error_of<skein::InvalidArgument>([&] { from_json<test_planner::Route>(json); });
  };
  CHECK(refusal("{\"points\": [") == "JSON: line 1, column 13: this is no JSON");
  CHECK(refusal(R"({"length_m": NaN})") ==
        "JSON: line 1, column 14: this is no JSON; write \"NaN\", with its quotes");
  CHECK(refusal(R"({"length_m": nan})") ==
        "JSON: line 1, column 14: this is no JSON; write \"NaN\", with its quotes");
  CHECK_THAT(refusal(R"({"length_m": Infinity})"), Catch::Contains("write \"Infinity\""));
  CHECK(refusal("[]") == "JSON: $ is no object, as test_planner::Route must be");
  CHECK(refusal(R"({"points": [], "length_m": 1})") ==
        "JSON: $ lacks the member 'remark' of test_planner::Route");
  CHECK(refusal(R"({"points": [], "lenght_m": 1, "remark": ""})") ==
        "JSON: $ has a member 'lenght_m', which test_planner::Route has not (did you mean "
        "'length_m'?); it lacks the member 'length_m' of test_planner::Route");
  CHECK(refusal("{}") ==
        "JSON: $ lacks the member 'points' of test_planner::Route; it lacks the member 'length_m' "
        "of test_planner::Route; it lacks the member 'remark' of test_planner::Route");
  CHECK(refusal("{\"length_m\":\n 1e400}") == "JSON: line 2, column 2: 1e400 is too large");
  CHECK(
      refusal(
          R"({"points": [{"east_m": 0, "north_m": "x", "up_m": 0}], "length_m": 1, "remark": ""})") ==
      "JSON: $.points[0].north_m is no number");
  const auto basic = [](std::string json) {
    return error_of<skein::InvalidArgument>([&] { from_json<Basic>(json); });
  };
  std::string json = to_json(samples::basic());
  json.replace(json.find("200"), 3, "256");
  CHECK(basic(json) == "JSON: $.byte is out of range: 256");
  json.replace(json.find("256"), 3, "-1");
  CHECK(basic(json) == "JSON: $.byte is out of range: -1");
  json.replace(json.find(":-1,"), 4, ":1.5,");
  CHECK(basic(json) == "JSON: $.byte is no integer");
  json.replace(json.find(":1.5,"), 5, ":1,");
  json.replace(json.find("Blue"), 4, "Blua");
  CHECK(basic(json) ==
        "JSON: $.colour is 'Blua', which is no value of everything::Colour (did you mean 'Blue'?)");
  CHECK(basic(std::string(100000, '[')) == "JSON: line 1, column 100001: this is no JSON");
}

TEST_CASE("identifiers that C++ reserves get an underscore") {
  using namespace names;
  _cxx_class value;
  value._cxx_int = 1;
  value._cxx_namespace = "n";
  value.std = 2;
  value.errno_ = 3;
  check_round_trips(value);
  CHECK(to_json(value) == R"({"int":1,"namespace":"n","std":2,"errno":3,"value":0})");
  switches choice;
  choice.discriminator_(4);
  CHECK(choice.discriminator() == keywords::_cxx_auto);
  const _cxx_virtual error("w", 1, 2);
  CHECK(error.what_ == "w");
  CHECK(error.info().name == "names::virtual");
}

TEST_CASE(
    "a key of at most 16 bytes is its own hash, big-endian and padded; a longer one is hashed") {
  ShortKey first{0x01020304, 1.5, 0xAA};
  CHECK(key_hash(first).hex() == "01020304aa0000000000000000000000");
  ShortKey second = first;
  second.value = 2.5;
  CHECK(key_hash(first) == key_hash(second));
  // printf '\0\0\0\4uav\0' | md5sum
  CHECK(key_hash(TextKey{"uav", 1}).hex() == "cc817899910374807f64abffce4a746b");
  PartKey part;
  part.part.id = 1;
  part.colour = Colour::Blue;
  CHECK(key_hash(part).hex() == "00000001000000020000000000000000");
  // In the order of the members, whatever the pragma's is.
  PairKey pair;
  pair.first = first;
  CHECK(key_hash(pair) == key_hash(first));
  CHECK(key_hash(WholeKey{{1, 2}, 3}).hex() == "01020000000000000000000000000000");
}

TEST_CASE("an argument borrows, owns and copies") {
  const std::string text = "borrowed";
  auto argument = skein::Argument<std::string>::borrow(text);
  CHECK(&argument.get() == &text);
  const skein::Argument<std::string> copy = argument;
  CHECK(&copy.get() != &text);
  CHECK(copy == argument);
  argument.own() = "own";
  CHECK(*argument == "own");
  CHECK(argument->size() == 3);
  CHECK(text == "borrowed");
}

}  // namespace everything
