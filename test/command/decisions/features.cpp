// What `skein decisions` says of the features of tasks, by invented logs.
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <random>

#include "command/decisions/feature_findings.hpp"

using namespace skein;
using namespace skein::command;
using Catch::Contains;
using introspection::Outcome;

namespace {

constexpr double kMs = 1e6;

/// Features of one request, and what came of it.
struct Invented {
  std::map<std::string, double> features;
  std::string csp = "Rows";
  double took_ms = 100;
  bool accepted = true;
  std::optional<double> quality{};
};

/// Numbers from 0 to 1 that come again with each run of the test.
struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  double operator()() { return static_cast<double>(engine() >> 8) / double{1 << 24}; }
  std::mt19937 engine;
};

introspection::Decision decision(const Invented& invented, const std::string& entity) {
  introspection::Decision made;
  made.entity = entity;
  made.service = "survey/IPlanner";
  made.strategy = "learned";
  for (const auto& [name, value] : invented.features) made.features.push_back({name, value});
  introspection::Attempt& attempt = made.attempts.emplace_back();
  attempt.csp = invented.csp;
  attempt.took = static_cast<std::int64_t>(invented.took_ms * kMs);
  attempt.outcome = invented.accepted ? Outcome::Accepted : Outcome::Rejected;
  if (invented.quality) attempt.quality = {*invented.quality};
  return made;
}

std::vector<std::string> told(int decisions, const std::function<Invented(int number)>& invent) {
  FeatureFindings findings;
  for (int i = 0; i < decisions; ++i) findings.add(decision(invent(i), "default/drone"));
  return findings.sentences();
}

}  // namespace

TEST_CASE("a feature that is the same for all requests is told with the remedy") {
  const auto same = [](int) { return Invented{{{"height_m", 120}}}; };
  CHECK(told(40, same) ==
        std::vector<std::string>{
            "default/drone, survey/IPlanner: the feature 'height_m' is 120 in all 40 decisions, "
            "and tells no request from another: leave it out, or give what differs from request "
            "to request"});
  CHECK(told(3, same).empty());  // may yet differ
}

TEST_CASE("a feature that differs by less than the Head keeps is one number to it") {
  Random random(1);
  const auto told_of = told(100, [&](int i) {
    const double second = i % 2;
    return Invented{{{"time_s", 1.7e9 + second}}, "Rows", 100 + 900 * second};
  });
  REQUIRE(told_of.size() == 1);
  CHECK_THAT(told_of[0], Contains("'time_s' varies only from 1700000000 to 1700000001") &&
                             Contains("subtract what all have in common"));
}

TEST_CASE("a feature that goes with the choice, the time, the success or the quality is none") {
  const unsigned seed = GENERATE(1u, 2u, 3u, 4u, 5u);
  const double scale = GENERATE(1.0, 1e6, 1e-6);
  Random random(seed);
  const auto noise = [&] { return 80 + 40 * random(); };
  std::function<Invented(double x)> invent;
  SECTION("with which CSP is chosen") {
    invent = [&](double x) { return Invented{{}, x < 0.5 ? "Rows" : "Spiral", noise()}; };
  }
  SECTION("with the time of the only one") {
    invent = [&](double x) { return Invented{{}, "Rows", noise() + 100 * x}; };
  }
  SECTION("with requests that are neither small nor large") {
    invent = [&](double x) {
      return Invented{{}, "Rows", noise() + (x > 0.3 && x < 0.6 ? 200 : 0)};
    };
  }
  SECTION("with what is rejected") {
    invent = [&](double x) { return Invented{{}, "Rows", noise(), x < 0.7}; };
  }
  SECTION("with what a result is worth") {
    invent = [&](double x) { return Invented{{}, "Rows", noise(), true, random() + x}; };
  }
  CHECK(told(200, [&](int) {
          const double x = random();
          Invented made = invent(x);
          made.features = {{"area", x * scale}};
          return made;
        }).empty());
}

TEST_CASE("a category goes with the choice, whatever its number") {
  Random random(7);
  CHECK(told(200, [&](int i) {
          const int kind = i % 4;
          return Invented{{{"kind", kind}}, kind == 2 ? "Spiral" : "Rows", 100 + random()};
        }).empty());
}

TEST_CASE("two features that count together alone are none") {
  Random random(3);
  CHECK(told(400, [&](int) {
          const double x = random(), y = random();
          return Invented{{{"x", x}, {"y", y}}, (x < 0.5) == (y < 0.5) ? "Rows" : "Spiral"};
        }).empty());
}

TEST_CASE("a feature that varies and goes with nothing is told, whatever its scale") {
  const double scale = GENERATE(1.0, 1e6, 1e-6);
  int times = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const auto sentences = told(200, [&](int) {
      const double area = random();
      return Invented{{{"area_m2", 1e6 * area}, {"luck", scale * random()}},
                      area < 0.5 ? "Rows" : "Spiral",
                      50 + 100 * random(),
                      random() < 0.9,
                      random()};
    });
    for (const std::string& sentence : sentences) {
      CHECK_THAT(sentence, Contains("the feature 'luck' varies, but in 200 decisions neither the "
                                    "choice of a CSP nor any CSP's time, success or quality goes "
                                    "with it: leave it out"));
    }
    times += static_cast<int>(sentences.size());
  }
  CHECK(times >= 18);  // what has nothing to do with it looks otherwise now and then
}

TEST_CASE("nothing is said of a feature that varies in few decisions, or that some requests lack") {
  Random random(9);
  CHECK(told(30, [&](int) { return Invented{{{"luck", random()}}}; }).empty());
  CHECK(told(100, [&](int i) {
          Invented made{{}, "Rows", 100 + 100.0 * (i % 2) + random()};
          if (i % 2 == 0) made.features["sensor"] = 1;
          made.features["size"] = made.took_ms;
          return made;
        }).empty());
}

TEST_CASE("each entity's features are looked at alone, and only the latest decisions") {
  FeatureFindings findings;
  for (int i = 0; i < 20; ++i) {
    findings.add(decision({{{"height_m", 1}}}, "default/one"));
    findings.add(decision({{{"height_m", 2}}}, "default/other"));
  }
  CHECK(findings.sentences().size() == 2);
  for (std::size_t i = 0; i < FeatureFindings::kMostDecisions; ++i)
    findings.add(decision({{{"length_m", 3}}}, "default/one"));
  CHECK_THAT(findings.sentences().at(0), Contains("'length_m' is 3 in all 10000 decisions"));
}
