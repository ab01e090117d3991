#include "skein/parameters.hpp"

#include <catch2/catch.hpp>

#include "skein/error.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

const ParameterResolver kResolver("INavigator",
                                  {{"Planner", false}, {"Time limit", true}, {"Aircraft", true}});

}  // namespace

TEST_CASE("a parameter's value comes from the caller, then the profile, then the dependencies") {
  const ParameterValues caller{{"Planner", "AStar"}};
  const ParameterValues profile{{"Planner", "RRTstar"}, {"Time limit", 2s}};
  const ParameterValues dependencies{{"Time limit", 9s}, {"Aircraft", 60.0}};
  const ParameterValues resolved = kResolver.resolve({caller, profile, dependencies});
  CHECK(resolved == ParameterValues{{"Planner", "AStar"}, {"Time limit", 2s}, {"Aircraft", 60.0}});
}

TEST_CASE("an optional parameter may stay without a value") {
  CHECK_FALSE(
      kResolver.resolve({{}, {{"Time limit", 1ms}, {"Aircraft", "x"}}}).contains("Planner"));
}

TEST_CASE("every required parameter without a value is named, with what to do") {
  CHECK_THROWS_AS(kResolver.resolve({{}, {}}), InvalidArgument);
  CHECK_THROWS_WITH(kResolver.resolve({{}, {}}),
                    Catch::Contains("INavigator") && Catch::Contains("'Time limit'") &&
                        Catch::Contains("'Aircraft'") && Catch::Contains("profile"));
}

TEST_CASE("a caller's parameter that is not declared is refused with the nearest one") {
  CHECK_THROWS_WITH(kResolver.resolve({{{"Planer", "AStar"}}}),
                    Catch::Contains("'Planer'") && Catch::Contains("did you mean 'Planner'"));
}

TEST_CASE("a value of a dependency that is not declared does not matter") {
  const ParameterValues profile{{"Time limit", 1ms}, {"Aircraft", "x"}};
  CHECK(kResolver.resolve({{}, profile, {{"Weather", "fog"}}}) == profile);
}

TEST_CASE("a value is read by its type, and converted where nothing is lost") {
  const ParameterValues values{{"Speed", 62.5},
                               {"Seed", 7},
                               {"Patience", 1500ms},
                               {"Loud", true},
                               {"Picture", "route.html"}};
  CHECK(values.get<double>("Speed") == 62.5);
  CHECK(values.get<std::uint32_t>("Seed") == 7);
  CHECK(values.get<double>("Seed") == 7);
  CHECK(values.get<std::chrono::milliseconds>("Patience") == 1500ms);
  CHECK(values.get<std::chrono::seconds>("Patience") == 1s);
  CHECK(values.get<bool>("Loud"));
  CHECK(values.get<std::string>("Picture") == "route.html");
  CHECK(values.find<double>("Climb") == std::nullopt);
}

TEST_CASE("a value of another type, of another size, or none, is refused by the parameter's name") {
  const ParameterValues values{{"Speed", 62.5},
                               {"Seed", 70'000},
                               {"Picture", "route.html"},
                               {"Patience", 1500ms},
                               {"Loud", true}};
  CHECK_THROWS_WITH(values.get<std::uint32_t>("Speed"),
                    Catch::StartsWith("the code asks for the parameter 'Speed' as an integer, and "
                                      "by the dictionary it is a real, 62.5; "));
  CHECK_THROWS_WITH(values.find<std::uint16_t>("Seed"),
                    Catch::StartsWith("the parameter 'Seed' is an integer, 70000, which does not "
                                      "fit into the integer type that the code asks for"));
  CHECK_THROWS_WITH(
      values.find<double>("Picture"),
      Catch::Contains("as a number, and by the dictionary it is a text, 'route.html'"));
  CHECK_THROWS_WITH(values.find<std::chrono::milliseconds>("Seed"),
                    Catch::Contains("as a duration, and by the dictionary it is an integer"));
  CHECK_THROWS_WITH(values.find<std::string>("Patience"),
                    Catch::Contains("as a text, and by the dictionary it is a duration, 1.5 s"));
  CHECK_THROWS_WITH(values.find<std::string>("Loud"),
                    Catch::Contains("as a text, and by the dictionary it is a boolean, true"));
  CHECK_THROWS_WITH(
      values.get<double>("Speedd"),
      Catch::Contains("'Speedd', which has no value (did you mean 'Speed'?); set it"));
  CHECK_THROWS_WITH(
      values.get<double>("Climb"),
      Catch::Contains("the code asks for the parameter 'Climb', which has no value") &&
          Catch::Contains("<required>"));
}

TEST_CASE("a live parameter that was moved from is still the same parameter") {
  const ParameterValues values{{"Time limit", 2s}};
  auto limit = values.live<std::chrono::seconds>("Time limit");
  const auto take = [](auto& from) { return std::move(from); };
  const auto moved = take(limit);
  CHECK(moved.get() == 2s);
  CHECK(limit.get() == 2s);
}
