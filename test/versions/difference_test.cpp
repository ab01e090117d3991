// In what two versions of an interface differ, as both sides describe it.
#include <catch2/catch.hpp>

#include "brokerless_discovery/versions.hpp"
#include "core/system/interface_name.hpp"
#include "harbour_1.idl.hpp"
#include "harbour_2.idl.hpp"
#include "idl/types/type_difference.hpp"
#include "skein/describe.hpp"
#include "skein/detail/type_support.hpp"

using namespace skein;

namespace harbour_1 = version_1::harbour;
namespace harbour_2 = version_2::harbour;

namespace {

/// What a client of `Here` is told of a provider of `There`; empty where it can call it.
template <class Here, class There>
std::string difference() {
  const InterfaceInfo& here = Here::interface_info();
  const InterfaceInfo& there = There::interface_info();
  const auto found = idl::difference_of_interfaces(scoped_interface_name(std::string(here.name)),
                                                   describe(here), describe(there));
  CHECK(found.has_value() != brokerless_discovery::understands(here, there));
  return found ? idl::in_words(*found) : "";
}

}  // namespace

#define TELLS(NAME, TEXT) CHECK(difference<harbour_1::NAME, harbour_2::NAME>() == (TEXT))

TEST_CASE("a parameter that differs is told with both types, directions or places") {
  TELLS(AnotherType,
        "operation 'plan': parameter 'from' is a string here and a harbour::Place there");
  TELLS(AnotherDirection, "operation 'plan': parameter 'depth' is inout here and in there");
  TELLS(RenamedParameter,
        "operation 'plan': parameter 'from' is called that here and called 'start' there");
  TELLS(SwappedParameters,
        "operation 'plan': parameter 'north_m' is number 1 here and number 2 there");
  TELLS(AddedParameter, "operation 'plan': parameter 'to' is missing here");
  TELLS(Inherited,
        "operation 'plan': parameter 'from' is a string here and a harbour::Place there");
  TELLS(Attribute, "operation '_get_level_m': the result is a double here and a float there");
}

TEST_CASE("an operation that differs as a whole is told by its name") {
  TELLS(NoResult, "operation 'count': the result is a long here and void there");
  TELLS(Oneway, "operation 'ring': the call is answered here and oneway there");
  TELLS(Missing, "operation 'land' is missing there");
  TELLS(RenamedOperation, "");  // inherited or not
  TELLS(More, "");
  CHECK(difference<harbour_2::More, harbour_1::More>() == "operation 'leave' is missing there");
}

TEST_CASE("a member is told by its path") {
  TELLS(Deep,
        "operation 'plan': request.route.points[].height_m is a float here and a double there");
  TELLS(DeepResult,
        "operation 'chart': result.rows[].cells[].depth_m is a long here and a short there");
  TELLS(AddedMember, "operation 'find': result.flag is missing here");
  TELLS(LostMember, "operation 'find': result.name is missing there");
  TELLS(RenamedMember,
        "operation 'find': result.mass_kg is called that here and called 'weight_kg' there");
  TELLS(SwappedMembers, "operation 'find': result.length_m is number 1 here and number 2 there");
  TELLS(Optional, "operation 'find': result.name is an optional string here and a string there");
  TELLS(Bound,
        "operation 'call': parameter 'numbers' is a sequence<long, 4> here and a "
        "sequence<long, 8> there");
  TELLS(Size, "operation 'row': result.cells is a long[4] here and a long[5] there");
  TELLS(Recursive, "operation 'root': result.mass_kg is a double here and a float there");
  TELLS(RenamedStruct, "");
}

TEST_CASE("enumerators, cases, bits and exceptions are told by their names") {
  TELLS(AddedEnumerator,
        "operation 'colour': the result: enumerator harbour::AddedEnumerator::Colour::White is "
        "missing here");
  TELLS(SwappedEnumerators,
        "operation 'side': the result: enumerator harbour::SwappedEnumerators::Side::Port is "
        "number 1 here and number 2 there");
  TELLS(AnotherValue,
        "operation 'tide': the result: enumerator harbour::AnotherValue::Tide::Flood is 2 here "
        "and 3 there");
  TELLS(AddedCase, "operation 'load': result.name is missing here");
  TELLS(AnotherLabel, "operation 'load': result.mass_kg is of case 1 here and of case 3 there");
  TELLS(AnotherCase, "operation 'load': result.mass_kg is a double here and a float there");
  TELLS(AnotherSwitch, "operation 'load': result.switch is a long here and a short there");
  TELLS(AnotherBit,
        "operation 'lights': the result: bit harbour::AnotherBit::Lights::green is 1 here and 4 "
        "there");
  TELLS(AnotherWidth, "operation 'radio': result.channel is of 3 bits here and of 5 bits there");
  TELLS(AddedException,
        "operation 'enter': exception harbour::Closed is not raised here and raised there");
  TELLS(LostException,
        "operation 'enter': exception harbour::Full is raised here and not raised there");
  TELLS(Inside, "operation 'enter': harbour::Inside::Busy.ships is a long here and a string there");
}

TEST_CASE("what may grow differs only where a reader would misread it") {
  TELLS(Grown, "");
  TELLS(ChangedAppendable, "operation 'find': result.mass_kg is a double here and a float there");
  TELLS(ChangedMutable,
        "operation 'crew': result.captain is called that here and called 'pilot' there");
  TELLS(MustBeUnderstood, "operation 'crew': result.cook is missing here");
  TELLS(ChangedGrowingCase, "operation 'load': result.mass_kg is a double here and a float there");
  TELLS(AnotherGrowth,
        "operation 'find': the result is an @appendable struct harbour::AnotherGrowth::Ship here "
        "and a @final struct harbour::AnotherGrowth::Ship there");
}

TEST_CASE("types of a topic are compared alike, by the name of the type") {
  const auto place = [](const TypeSupport& here, const TypeSupport& there) {
    const auto found = idl::difference_of_types(describe(here), describe(there));
    return found ? found->place : "";
  };
  using idl::type_support;
  CHECK(place(type_support<harbour_1::Grown::Ship>(), type_support<harbour_2::Grown::Ship>())
            .empty());
  CHECK(place(type_support<harbour_1::Grown::Crew>(), type_support<harbour_2::Grown::Crew>())
            .empty());
  CHECK(place(type_support<harbour_1::Deep::Wish>(), type_support<harbour_2::Deep::Wish>()) ==
        "harbour::Deep::Wish.route.points[].height_m");
  CHECK(place(type_support<harbour_1::ChangedAppendable::Ship>(),
              type_support<harbour_2::ChangedAppendable::Ship>()) ==
        "harbour::ChangedAppendable::Ship.mass_kg");
  CHECK(place(type_support<harbour_1::AddedMember::Ship>(),
              type_support<harbour_2::AddedMember::Ship>()) == "harbour::AddedMember::Ship.flag");
}

TEST_CASE("what describes no such interface, or only a part of it, is no difference") {
  const auto here = describe(harbour_1::Deep::interface_info());
  CHECK_FALSE(idl::difference_of_interfaces("harbour::Deep", here, {}));
  auto partial = describe(harbour_2::Deep::interface_info());
  partial.declarations.clear();
  CHECK_FALSE(idl::difference_of_interfaces("harbour::Deep", here, partial));
}

TEST_CASE("a description that lacks what its kind has is no difference") {
  const auto here = describe(harbour_1::AnotherType::interface_info());
  auto there = here;
  there.interfaces[0].operations[0].parameters[0].type = {types::Kind::Sequence, 0, "", {}};
  CHECK_FALSE(idl::difference_of_interfaces("harbour::AnotherType", here, there));
}

TEST_CASE("what another peer describes is shown as what it is, and ends") {
  const auto here = describe(harbour_1::AnotherType::interface_info());
  auto there = describe(harbour_2::AnotherType::interface_info());
  there.interfaces[0].operations[0].parameters[0].type.name = "\x1b[2J" + std::string(9999, 'x');
  const auto found = idl::difference_of_interfaces("harbour::AnotherType", here, there);
  REQUIRE(found);
  CHECK_THAT(idl::in_words(*found), Catch::Contains("\\x1b[2J"));
  CHECK(idl::in_words(*found).size() < 700);
}
