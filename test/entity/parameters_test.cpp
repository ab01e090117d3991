#include "skein/parameters.hpp"

#include <catch2/catch.hpp>

#include "skein/error.hpp"

using namespace skein;

namespace {

const ParameterResolver kResolver("INavigator",
                                  {{"Planner", false}, {"Time limit", true}, {"Aircraft", true}});

}  // namespace

TEST_CASE("a parameter's value comes from the caller, then the profile, then the dependencies") {
  const ParameterValues caller{{"Planner", "AStar"}};
  const ParameterValues profile{{"Planner", "RRTstar"}, {"Time limit", "2 s"}};
  const ParameterValues dependencies{{"Time limit", "9 s"}, {"Aircraft", "60 m/s"}};
  const ParameterValues resolved = kResolver.resolve({caller, profile, dependencies});
  CHECK(resolved ==
        ParameterValues{{"Planner", "AStar"}, {"Time limit", "2 s"}, {"Aircraft", "60 m/s"}});
}

TEST_CASE("an optional parameter may stay without a value") {
  CHECK_FALSE(
      kResolver.resolve({{}, {{"Time limit", "1"}, {"Aircraft", "x"}}}).contains("Planner"));
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
  const ParameterValues profile{{"Time limit", "1"}, {"Aircraft", "x"}};
  CHECK(kResolver.resolve({{}, profile, {{"Weather", "fog"}}}) == profile);
}
