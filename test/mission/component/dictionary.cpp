#include "mission/component/dictionary.hpp"

#include <catch2/catch.hpp>

#include "test/tools/places.hpp"

using namespace skein::profile;
using namespace std::chrono_literals;
using skein::test::project_file;

namespace {

DictionaryEntry entry_of(ValueType type, std::string unit = "",
                         std::optional<double> minimum = std::nullopt,
                         std::optional<double> maximum = std::nullopt) {
  DictionaryEntry entry;
  entry.name = std::string(1, 'x');
  entry.type = type;
  entry.unit = std::move(unit);
  entry.minimum = minimum;
  entry.maximum = maximum;
  return entry;
}

std::string findings_in(const std::string& entries) {
  try {
    parse_dictionary("<dictionary>" + entries + "</dictionary>", "d.xml");
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("The dictionary that is shipped can be read and knows what the paper uses") {
  const auto dictionary = read_dictionary(project_file("mission_profiles/dictionary.xml"));
  const auto* latency = dictionary.find(EntryKind::Attribute, "latency");
  REQUIRE(latency != nullptr);
  CHECK(std::get<std::chrono::nanoseconds>(parse_value(*latency, "100 ms")) == 100ms);
  const auto* planner = dictionary.find(EntryKind::Parameter, "Planner");
  REQUIRE(planner != nullptr);
  CHECK(planner->interface == "AE_navigator/IPlanner");
  CHECK(dictionary.find(EntryKind::Parameter, "latency") == nullptr);
}

TEST_CASE("Values are read by their type") {
  CHECK(std::get<std::int64_t>(parse_value(entry_of(ValueType::Integer), " -7 ")) == -7);
  CHECK(std::get<double>(parse_value(entry_of(ValueType::Real), "2.5e3")) == 2500.0);
  CHECK(std::get<bool>(parse_value(entry_of(ValueType::Boolean), "true")));
  CHECK(std::get<std::string>(parse_value(entry_of(ValueType::Text), "a b")) == "a b");
  const auto duration = entry_of(ValueType::Duration, "ms");
  CHECK(std::get<std::chrono::nanoseconds>(parse_value(duration, "1.5 s")) == 1500ms);
  CHECK(std::get<std::chrono::nanoseconds>(parse_value(duration, "250us")) == 250us);
}

TEST_CASE("A length of time without a unit is refused, and both readings are offered") {
  const auto duration = entry_of(ValueType::Duration, "ms");
  CHECK_THROWS_WITH(parse_value(duration, "300"),
                    "\"x\" is \"300\", which has no unit of time; write \"300 ms\" or \"300 s\", "
                    "whichever it is (ns, us, ms, s, min, h)");
  CHECK_THROWS_WITH(parse_duration(" 3000 "),
                    "\" 3000 \" has no unit of time; write \"3000 ms\" or \"3000 s\", "
                    "whichever it is (ns, us, ms, s, min, h)");
  CHECK_THROWS_AS(parse_duration("0"), skein::InvalidArgument);
}

TEST_CASE("A length of time leaves room for multiples of it") {
  CHECK(4 * parse_duration("438000 h") > std::chrono::nanoseconds(0));
  CHECK_THROWS_AS(parse_duration("876000 h"), skein::InvalidArgument);
  CHECK(parse_seconds("1e300") < 4.0 * 365 * 24 * 3600 * 50);
}

TEST_CASE("A number may name its unit, or another of the same quantity") {
  const auto real = [](const std::string& unit, const std::string& text) {
    return std::get<double>(parse_value(entry_of(ValueType::Real, unit), text));
  };
  CHECK(real("m", "26.5 km") == 26500);
  CHECK(real("m/s", "90 km/h") == Approx(25));
  CHECK(real("deg", "3.14159265358979 rad") == Approx(180));
  CHECK(real("m", "5m") == 5);
  CHECK(real("m", "5") == 5);
  CHECK(real("m/s2", "5 m/s2") == 5);
  CHECK(std::get<std::int64_t>(parse_value(entry_of(ValueType::Integer, "px"), "5 px")) == 5);
  CHECK_THROWS_WITH(
      real("m", "5 s"),
      "\"x\" is \"5 s\", which is no real in m: write a number in mm, cm, m, km or ft");
  CHECK_THROWS_WITH(real("", "5 m"),
                    "\"x\" is \"5 m\", which is no real: the dictionary gives it no unit; write "
                    "the number alone");
  CHECK_THROWS_WITH(parse_value(entry_of(ValueType::Real, "m", 0, 1000), "26.5 km"),
                    "\"x\" is 26500 m, more than 1000 m");
  CHECK_THROWS_AS(parse_value(entry_of(ValueType::Integer, "m"), "5 km"), skein::InvalidArgument);
}

TEST_CASE("Other peers are told numbers and durations in the unit of the dictionary") {
  CHECK(plain_text(entry_of(ValueType::Duration, "ms"), "1.5 s") == "1500");
  CHECK(plain_text(entry_of(ValueType::Real, "m"), "26.5 km") == "26500");
  CHECK(plain_text(entry_of(ValueType::Integer), " 7 ") == "7");
  CHECK(plain_text(entry_of(ValueType::Boolean), " true ") == "true");
  CHECK(plain_text(entry_of(ValueType::Text), " a b ") == "a b");
}

TEST_CASE("A length of time at a command line is seconds, or has a unit, and fits into a clock") {
  CHECK(parse_seconds("1.5") == 1.5);
  CHECK(parse_seconds("500ms") == 0.5);
  CHECK(parse_seconds("20 us") == 20e-6);
  CHECK(parse_seconds("2min") == 120);
  CHECK(parse_seconds("0") == 0);
  CHECK(parse_seconds("1e300") == parse_seconds("1e10"));
  CHECK(std::chrono::duration<double>(parse_seconds("1e300")) < std::chrono::nanoseconds::max());
  for (const char* text : {"-1", "-0", "nan", "inf", "", "5 parsecs", "1,5"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_seconds(text), skein::InvalidArgument);
  }
}

TEST_CASE("A value of another type is refused") {
  const auto [type, text] = GENERATE(table<ValueType, std::string>({
      {ValueType::Integer, "1.5"},
      {ValueType::Integer, "0x10"},
      {ValueType::Integer, "99999999999999999999"},
      {ValueType::Integer, ""},
      {ValueType::Real, "1,5"},
      {ValueType::Real, "nan"},
      {ValueType::Real, "inf"},
      {ValueType::Real, "1e999"},
      {ValueType::Boolean, "yes"},
      {ValueType::Duration, "soon"},
      {ValueType::Duration, "-1 s"},
      {ValueType::Duration, "5 parsec"},
      {ValueType::Duration, "1e300 h"},
      {ValueType::Duration, "nan"},
  }));
  CAPTURE(text);
  CHECK_THROWS_AS(parse_value(entry_of(type, "ms"), text), skein::InvalidArgument);
}

TEST_CASE("What is refused is told with what to write instead") {
  const auto refusal = [](const DictionaryEntry& entry, const std::string& text) -> std::string {
    try {
      parse_value(entry, text);
    } catch (const skein::InvalidArgument& error) {
      return error.what();
    }
    return "taken";
  };
  CHECK(refusal(entry_of(ValueType::Real), "0,6") ==
        "\"x\" is \"0,6\", which is no real: write \"0.6\", with a point");
  CHECK(refusal(entry_of(ValueType::Real, "m"), "26,5 km") ==
        "\"x\" is \"26,5 km\", which is no real in m: write \"26.5 km\", with a point");
  CHECK(refusal(entry_of(ValueType::Real, "m/s"), "18 mph") ==
        "\"x\" is \"18 mph\", which is no real in m/s: write a number in m/s, km/h or kn");
  CHECK(
      refusal(entry_of(ValueType::Real, "mps"), "18 km/h") ==
      "\"x\" has the unit \"mps\", into which \"18 km/h\" is not converted (did you mean 'm/s'?)");
  CHECK(refusal(entry_of(ValueType::Integer, "m"), "5 km") ==
        "\"x\" is \"5 km\", which is no integer in m: write the number alone, or in m");
  CHECK(refusal(entry_of(ValueType::Integer, "", 0, 50), "99999999999999999999") ==
        "\"x\" is 99999999999999999999, more than 50");
  CHECK(refusal(entry_of(ValueType::Integer), "-99999999999999999999") ==
        "\"x\" is -99999999999999999999, less than -9223372036854775808");
}

TEST_CASE("A name that is of the other kind is told as such") {
  const auto dictionary = parse_dictionary(
      R"(<dictionary><attribute name="Speed" type="real">How fast.</attribute></dictionary>)",
      "d.xml");
  CHECK(dictionary.suggestion(EntryKind::Parameter, "Speed") ==
        "the dictionary has it as an attribute (d.xml:1:13); define it as <parameter> there");
}

TEST_CASE("Of a type that is none, nothing else is said") {
  const std::string findings =
      findings_in(R"(<parameter name="Speed" type="double" unit="m/s" min="1">Fast.</parameter>)");
  CHECK_THAT(findings, Catch::Contains("\"double\" is no type; write \"real\""));
  CHECK_THAT(findings, !Catch::Contains("has a unit"));
}

TEST_CASE("A range holds its ends, and durations are compared in the unit of their entry") {
  const auto entry = entry_of(ValueType::Duration, "ms", 10, 1000);
  CHECK_NOTHROW(parse_value(entry, "10 ms"));
  CHECK_NOTHROW(parse_value(entry, "1 s"));
  CHECK_THROWS_WITH(parse_value(entry, "9.9 ms"), "\"x\" is 9.9 ms, less than 10 ms");
  CHECK_THROWS_WITH(parse_value(entry, "2 s"), "\"x\" is 2000 ms, more than 1000 ms");
}

TEST_CASE("An unknown name is answered with the nearest of its kind") {
  const auto dictionary = read_dictionary(project_file("mission_profiles/dictionary.xml"));
  CHECK_THAT(dictionary.suggestion(EntryKind::Attribute, "latancy"),
             Catch::Contains("did you mean 'latency'?"));
  CHECK_THAT(dictionary.suggestion(EntryKind::Parameter, "Time_limit"),
             Catch::Contains("did you mean 'Time limit'?"));
  CHECK_THAT(dictionary.suggestion(EntryKind::Attribute, "colour of the hull"),
             Catch::Contains("known are") && Catch::Contains("add it to the dictionary"));
}

TEST_CASE("A dictionary's own mistakes are found") {
  const auto [entries, problem] = GENERATE(table<std::string, std::string>({
      {R"(<attribute name="a" type="number">x</attribute>)", "\"number\" is no type"},
      {R"(<attribute name="a" type="duration">x</attribute>)", "has no unit"},
      {R"(<attribute name="a" type="duration" unit="m">x</attribute>)", "the unit \"m\""},
      {R"(<attribute name="a" type="text" min="1">x</attribute>)", "has a unit or a range"},
      {R"(<attribute name="a" type="real" min="2" max="1">x</attribute>)",
       "range of \"a\" is empty"},
      {R"(<attribute name="a" type="real" min="low">x</attribute>)", "\"low\", which is no real"},
      {R"(<attribute name="latency" type="text">x</attribute>)",
       "the attribute \"latency\" is a text, and Skein reads it as something else; write "
       "type=\"duration\" unit=\"ms\"; its values may be in other units of time"},
      {R"(<attribute name="latency" type="duration" unit="s">x</attribute>)",
       "the attribute \"latency\" is a duration in s, and Skein reads it as something else"},
      {R"(<attribute name="quality" type="duration" unit="s">x</attribute>)",
       "write type=\"real\""},
      {R"(<attribute name="isolated" type="text">x</attribute>)", "write type=\"boolean\""},
      {R"(<attribute name="a" type="real"/>)", "is not documented"},
      {R"(<attribute type="real">x</attribute>)", "<attribute> has no name"},
      {R"(<attribute name="a">x</attribute>)", "<attribute> has no type"},
      {R"(<parameter name="a" type="text" interface="I">x</parameter>)", "has an interface"},
      {R"(<parameter name="a" type="service" interface="I I">x</parameter>)", "no interface name"},
      {R"(<entry/>)", "<entry> is unknown in <dictionary>"},
      {R"(<attribute name="a" type="text">x</attribute><attribute name="a" type="text">y</attribute>)",
       "\"a\" is defined twice; the first is at d.xml:1:13"},
  }));
  CHECK_THAT(findings_in(entries), Catch::Contains(problem));
}

TEST_CASE("An attribute and a parameter may have the same name") {
  CHECK(findings_in(R"(<attribute name="a" type="text">x</attribute>
                       <parameter name="a" type="real">y</parameter>)") == "");
}
