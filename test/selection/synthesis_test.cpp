#include <catch2/catch.hpp>
#include <cmath>

#include "skein/error.hpp"
#include "skein/evaluation.hpp"

using namespace skein;

namespace {

std::vector<Opinion<double>> opinions(std::vector<double> values) {
  std::vector<Opinion<double>> opinions;
  for (const double value : values)
    opinions.push_back({std::string(1, static_cast<char>('A' + opinions.size())), value});
  return opinions;
}

}  // namespace

TEST_CASE("of several results the cheapest is taken, and of equals the first") {
  const auto best = best_by_cost<double>([](const double& value) { return std::abs(value); });
  CHECK(best(opinions({3, -1, 2}))->result == -1);
  CHECK(best(opinions({1, -1}))->result == 1);
  CHECK_THAT(best(opinions({3, -1, 2}))->how, Catch::Contains("B costs least of 3"));
}

TEST_CASE("a majority is those that agree, and there is none below the quorum") {
  const auto vote = majority_vote<double>(2);
  CHECK(vote(opinions({1, 2, 1}))->result == 1);
  CHECK_THAT(vote(opinions({1, 2, 1}))->how, Catch::Contains("A, C agree, of 3"));
  CHECK_FALSE(vote(opinions({1, 2, 3})).has_value());
  CHECK_FALSE(vote(opinions({1})).has_value());
  CHECK(vote(opinions({1, 2, 1, 2, 2}))->result == 2);
}

TEST_CASE("what is the same is for the caller to say") {
  const auto vote =
      majority_vote<double>(2, [](double a, double b) { return std::floor(a) == std::floor(b); });
  CHECK(vote(opinions({2.5, 1.1, 1.9}))->result == 1.1);
}

TEST_CASE("a weighted vote adds up the weights of those that agree") {
  const auto vote = weighted_vote<double>(
      [](const auto& opinion) { return opinion.csp == "C" ? 3.0 : 1.0; }, 2.5);
  CHECK(vote(opinions({1, 1, 2}))->result == 2);
  CHECK_FALSE(vote(opinions({1, 1})).has_value());
}

TEST_CASE(
    "the value in the middle is right while fewer than half are wrong, however wrong they are") {
  const auto middle = mid_value<double>();
  CHECK(middle(opinions({5.0, 5.1, 1e300}))->result == 5.1);
  CHECK(middle(opinions({-1e300, 5.1, 5.0}))->result == 5.0);
  CHECK(middle(opinions({1, 2}))->result == 1);
  CHECK(middle(opinions({7}))->result == 7);
}

TEST_CASE("an evaluation asks its checks in order and names the one that rejects") {
  Evaluation<double> evaluation;
  evaluation
      .check("finite",
             [](double value) {
               return std::isfinite(value) ? std::nullopt : std::optional<std::string>("it is not");
             })
      .check("positive",
             [](double value) {
               return value > 0 ? std::nullopt
                                : std::optional<std::string>("it is " + std::to_string(value));
             })
      .admitted("exact", [](double value) {
        return value != 7 ? std::nullopt : std::optional<std::string>("it is approximate");
      });
  CHECK_FALSE(evaluation(1.0).has_value());
  CHECK(evaluation(-INFINITY)->check == "finite");
  CHECK(evaluation(-1)->check == "positive");
  CHECK(evaluation(-1)->fault);
  CHECK(evaluation(7)->reason == "it is approximate");
  CHECK_FALSE(evaluation(7)->fault);
}

TEST_CASE("without checks every result passes, and a function that judges is one check") {
  CHECK_FALSE(Evaluation<double>()(-1).has_value());
  const Evaluation<double> evaluation = [](double) { return std::optional<std::string>("no"); };
  CHECK(evaluation(1)->reason == "no");
}

TEST_CASE("a check without a function is refused when it is added") {
  Evaluation<double> evaluation;
  CHECK_THROWS_AS(evaluation.check("reachable", nullptr), InvalidArgument);
  CHECK_THROWS_WITH(evaluation.check("reachable", nullptr),
                    "the check 'reachable' has no function: null");
  CHECK_THROWS_AS(evaluation.admitted("exact", nullptr), InvalidArgument);
}

TEST_CASE("a check that rejects without a reason is named in its place") {
  Evaluation<double> evaluation;
  evaluation.check("reachable", [](double) { return std::optional<std::string>(""); });
  CHECK(evaluation(1)->reason == "the check 'reachable' gives no reason");
}
