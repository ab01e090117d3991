#include "skein/selection.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <stdexcept>

#include "skein/error.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

Candidate declared(std::string name, std::optional<Duration> latency, double quality) {
  Candidate candidate;
  candidate.name = std::move(name);
  candidate.latency = latency;
  candidate.quality = quality;
  return candidate;
}

const std::vector<Candidate> kThree{declared("thorough", 1500ms, 0.95),
                                    declared("quick", 20ms, 0.5), declared("middling", 300ms, 0.9)};

Selection declared(Duration remaining) {
  return make_declared_selection()->select(kThree, {.remaining = remaining});
}

std::string chosen(const std::vector<Candidate>& candidates, Duration remaining) {
  return candidates
      [make_declared_selection()->select(candidates, {.remaining = remaining}).candidate]
          .name;
}

}  // namespace

TEST_CASE("a strategy that selects a candidate that is not there is named") {
  struct Beyond final : SelectionStrategy {
    std::string name() const override { return "beyond"; }
    Selection select(const std::vector<Candidate>& candidates, const Situation&) const override {
      return {candidates.size(), 1s, ""};
    }
  };
  const Beyond beyond;
  CandidateIterator iterator(beyond, {declared("only", 10ms, 1)}, {});
  CHECK_THROWS_WITH(iterator.next(1s), Catch::Contains("'beyond'"));
}

TEST_CASE("a strategy that gives a CSP no time is named, and no CSP pays for it") {
  struct Stingy final : SelectionStrategy {
    explicit Stingy(Duration given) : slice(given) {}
    std::string name() const override { return "stingy"; }
    Selection select(const std::vector<Candidate>&, const Situation&) const override {
      return {0, slice, ""};
    }
    Duration slice;
  };
  const auto next = [](Duration slice) {
    const Stingy stingy(slice);
    CandidateIterator(stingy, {declared("only", 10ms, 1)}, {}).next(1s);
  };
  CHECK_THROWS_AS(next(-5ms), Internal);
  CHECK_THROWS_WITH(next(-5ms),
                    "the strategy 'stingy' gave CSP 'only' a time slice of -5 ms, while 1000 ms "
                    "are left; a slice (Selection::slice) is longer than 0");
  CHECK_THROWS_WITH(next(0ms), Catch::Contains("a time slice of 0 ms"));
}

TEST_CASE("what a strategy throws is told as the strategy's") {
  struct Broken final : SelectionStrategy {
    explicit Broken(std::function<void()> thrower) : fail(std::move(thrower)) {}
    std::string name() const override { return "mine"; }
    Selection select(const std::vector<Candidate>&, const Situation&) const override {
      fail();
      return {};
    }
    std::function<void()> fail;
  };
  const auto next = [](std::function<void()> thrower) {
    const Broken broken(std::move(thrower));
    CandidateIterator(broken, {declared("only", 10ms, 1)}, {}).next(1s);
  };
  const auto standard = [] { throw std::runtime_error("table empty"); };
  const auto number = [] { throw 42; };
  const auto own = [] { throw Unavailable("no table"); };
  CHECK_THROWS_AS(next(standard), Internal);
  CHECK_THROWS_WITH(next(standard), "the strategy 'mine' threw: table empty");
  CHECK_THROWS_AS(next(number), Internal);
  CHECK_THROWS_WITH(next(number), "the strategy 'mine' threw: something that is no std::exception");
  CHECK_THROWS_AS(next(own), Unavailable);
  CHECK_THROWS_WITH(next(own), "the strategy 'mine' threw: no table");
}

TEST_CASE("whoever is selected gets some time, also where others need just what is left") {
  const std::vector<Candidate> pair{declared("undeclared", std::nullopt, 0.9),
                                    declared("quick", 100ms, 0.5)};
  const auto declared = make_declared_selection();
  CandidateIterator iterator(*declared, pair, {});
  CHECK(iterator.next(100ms).selection.slice == 100ms);
  const auto in_order = make_fixed_order_selection();
  CandidateIterator last_moment(*in_order, kThree, {});
  CHECK(last_moment.next(2ns).selection.slice > 0ns);
}

TEST_CASE("a slice is never longer than the time left") {
  struct Generous final : SelectionStrategy {
    std::string name() const override { return "generous"; }
    Selection select(const std::vector<Candidate>&, const Situation&) const override {
      return {0, Duration::max(), ""};
    }
  };
  const Generous generous;
  CandidateIterator iterator(generous, {declared("only", 10ms, 1)}, {});
  CHECK(iterator.next(1s).selection.slice == 1s);
}

TEST_CASE("the best declared quality that fits into the time left is selected") {
  CHECK(chosen(kThree, 2s) == "thorough");
  CHECK(chosen(kThree, 1s) == "middling");
  CHECK(chosen(kThree, 50ms) == "quick");
}

TEST_CASE("where no declared latency fits the fastest is selected and gets all of the time") {
  const Selection selection = declared(5ms);
  CHECK(kThree[selection.candidate].name == "quick");
  CHECK(selection.slice == 5ms);
  CHECK_THAT(selection.reason, Catch::Contains("no declared latency fits"));
}

TEST_CASE("time for the fastest other candidate is kept in reserve where that leaves enough") {
  CHECK(declared(2s).slice == 1980ms);
  CHECK(declared(1510ms).slice == 1510ms);
}

TEST_CASE("of plenty of time half is kept in reserve: who needs more than that hangs") {
  CHECK(declared(100s).slice == 50s);
  CHECK(declared(8s).slice == 6s);  // four times its latency
}

TEST_CASE("where no other declares a latency, each has an even share of the time kept for it") {
  const auto slice = [](std::optional<Duration> latency) {
    return make_declared_selection()
        ->select({declared("best", latency, 0.9), declared("silent", std::nullopt, 0.5)},
                 {.remaining = 1s})
        .slice;
  };
  CHECK(slice(std::nullopt) == 500ms);
  CHECK(slice(100ms) == 500ms);
  CHECK(slice(800ms) == 800ms);
}

TEST_CASE("equal quality is decided by latency") {
  CHECK(chosen({declared("slow", 30ms, 0.5), declared("fast", 10ms, 0.5)}, 1s) == "fast");
}

TEST_CASE("a candidate that declares no latency is not ruled out by time") {
  CHECK(chosen({declared("silent", std::nullopt, 0.9), declared("fast", 10ms, 0.5)}, 20ms) ==
        "silent");
}

TEST_CASE("the reason of a selection names the candidate, its quality and the time") {
  CHECK_THAT(declared(2s).reason, Catch::Contains("thorough") && Catch::Contains("0.95") &&
                                      Catch::Contains("2000 ms") && Catch::Contains("1500 ms"));
}

TEST_CASE("the fixed order takes the first and shares the time evenly") {
  const Selection selection = make_fixed_order_selection()->select(kThree, {.remaining = 900ms});
  CHECK(selection.candidate == 0);
  CHECK(selection.slice == 300ms);
}
