#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "skein/error.hpp"
#include "skein/selection.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

Candidate candidate(std::string name, Duration latency, double quality,
                    std::optional<Prediction> learned = {}) {
  Candidate candidate;
  candidate.name = std::move(name);
  candidate.latency = latency;
  candidate.quality = quality;
  candidate.learned = learned;
  return candidate;
}

Prediction shown(Duration median, Duration p95, double quality, double reliability = 1,
                 std::uint64_t idle = 0) {
  return {12, median, p95, quality, reliability, idle};
}

Selection select(const std::vector<Candidate>& candidates, Duration remaining,
                 double exploration = 0, History::Decisions past = {}) {
  return make_learned_selection()->select(candidates, {{}, remaining, exploration, past});
}

}  // namespace

TEST_CASE("what a CSP has shown counts, not what it declares") {
  const std::vector<Candidate> two{candidate("boaster", 10ms, 0.9, shown(400ms, 500ms, 0.9)),
                                   candidate("honest", 50ms, 0.5, shown(50ms, 60ms, 0.5))};
  CHECK(select(two, 200ms).candidate == 1);
  CHECK(select(two, 2s).candidate == 0);
}

TEST_CASE("until it has run, a CSP is taken at its word") {
  const std::vector<Candidate> two{candidate("new", 10ms, 0.9),
                                   candidate("old", 50ms, 0.5, shown(50ms, 60ms, 0.5))};
  const Selection selection = select(two, 200ms);
  CHECK(selection.candidate == 0);
  CHECK_THAT(selection.reason, Catch::Contains("has not run before"));
}

TEST_CASE("a CSP whose results are rejected is selected less, however good they claim to be") {
  CHECK(select({candidate("liar", 10ms, 0.9, shown(10ms, 10ms, 0.9, 0.3)),
                candidate("sound", 10ms, 0.5)},
               1s)
            .candidate == 1);
}

TEST_CASE("of those that are nearly equally useful the quickest is selected") {
  CHECK(select({candidate("slow", 10ms, 0.9, shown(90ms, 95ms, 0.91)),
                candidate("fast", 10ms, 0.9, shown(10ms, 95ms, 0.9))},
               1s)
            .candidate == 1);
}

TEST_CASE("the p95 latency of the quickest other CSP is kept in reserve where it fits") {
  const std::vector<Candidate> two{candidate("good", 0ms, 0.9, shown(400ms, 500ms, 0.9)),
                                   candidate("quick", 0ms, 0.1, shown(20ms, 30ms, 0.1))};
  CHECK(select(two, 1s).slice == 970ms);
  CHECK(select(two, 1s).expected == 500ms);
  CHECK(select(two, 510ms).slice == 510ms);
}

TEST_CASE("of plenty of time half is left to others, should the best one hang") {
  const std::vector<Candidate> two{candidate("good", 0ms, 0.9, shown(90ms, 100ms, 0.9)),
                                   candidate("other", 0ms, 0.1, shown(20ms, 30ms, 0.1))};
  CHECK(select(two, 2s).slice == 1s);
  CHECK_THAT(select(two, 2s).reason, Catch::Contains("1000 ms are kept for a fall-back"));
  CHECK(select(two, 500ms).slice == 400ms);
  CHECK(select(two, 410ms).slice == 380ms);
  CHECK(select({two[0]}, 2s).slice == 2s);
}

TEST_CASE(
    "a quick CSP that often fails has a short try first where that costs less than it saves") {
  const auto sound = candidate("sound", 0ms, 0.9, shown(80ms, 100ms, 0.9));
  const auto chancy = [&](double reliability, double quality = 0.9) {
    return std::vector<Candidate>{
        sound, candidate("chancy", 0ms, 0.9, shown(8ms, 10ms, quality, reliability))};
  };
  const Selection selection = select(chancy(0.2), 1s);
  CHECK(selection.candidate == 1);
  CHECK(selection.slice == 10ms);
  CHECK_THAT(selection.reason, Catch::Contains("worth a try before sound"));
  CHECK(select(chancy(0.05), 1s).candidate == 0);      // 8 ms for one in twenty
  CHECK(select(chancy(0.2, 0.5), 1s).candidate == 0);  // not as good
  CHECK(select(chancy(0.2), 105ms).candidate == 0);    // no time for both
}

TEST_CASE("where no p95 latency fits the fastest is selected and gets all of the time") {
  const Selection selection = select({candidate("good", 0ms, 0.9, shown(400ms, 500ms, 0.9)),
                                      candidate("quick", 0ms, 0.1, shown(20ms, 30ms, 0.1))},
                                     10ms);
  CHECK(selection.candidate == 1);
  CHECK(selection.slice == 10ms);
}

TEST_CASE(
    "the CSP that has not run for longest is explored, within the budget and where time for the "
    "best is left") {
  const std::vector<Candidate> three{candidate("best", 0ms, 0.9, shown(90ms, 100ms, 0.9)),
                                     candidate("stale", 0ms, 0.1, shown(20ms, 30ms, 0.1, 1, 50)),
                                     candidate("fresh", 0ms, 0.1, shown(20ms, 30ms, 0.1, 1, 5))};
  const Selection selection = select(three, 1s, 0.1, {.made = 9, .explored = 0});
  CHECK(selection.explores);
  CHECK(selection.candidate == 1);
  CHECK(selection.slice == 900ms);
  CHECK_FALSE(select(three, 1s, 0.1, {.made = 8, .explored = 0}).explores);
  CHECK_FALSE(select(three, 1s, 0.1, {.made = 18, .explored = 1}).explores);
  CHECK(select(three, 1s, 0.1, {.made = 19, .explored = 1}).explores);
  CHECK_FALSE(select(three, 120ms, 0.1, {.made = 9, .explored = 0}).explores);
}

TEST_CASE("the same arguments give the same selection, bit for bit") {
  const std::vector<Candidate> two{candidate("a", 10ms, 0.9, shown(9ms, 11ms, 0.8)),
                                   candidate("b", 10ms, 0.7)};
  const Selection first = select(two, 1s), second = select(two, 1s);
  CHECK(first.candidate == second.candidate);
  CHECK(first.slice == second.slice);
  CHECK(first.expected == second.expected);
  CHECK(first.reason == second.reason);
}

TEST_CASE("CSPs in quarantine are passed over, unless all are") {
  auto sick = candidate("sick", 10ms, 0.9);
  sick.breaker = CircuitBreaker::State::Open;
  sick.quarantine = 5s;
  auto sicker = sick;
  sicker.name = "sicker";
  sicker.quarantine = 9s;
  const auto strategy = make_declared_selection();
  CandidateIterator with_sound(*strategy, {sicker, sick, candidate("sound", 10ms, 0.1)}, {});
  CHECK(with_sound.next(1s).candidate.name == "sound");
  CHECK(with_sound.done());
  CandidateIterator without(*strategy, {sicker, sick}, {});
  CHECK(without.next(1s).candidate.name == "sick");
  CHECK(without.done());
}

TEST_CASE("only the first choice for a request explores") {
  const auto strategy = make_learned_selection();
  CandidateIterator iterator(*strategy,
                             {candidate("a", 1ms, 0.9, shown(1ms, 1ms, 0.9)),
                              candidate("b", 1ms, 0.5), candidate("c", 1ms, 0.5)},
                             {{}, 1s, 1.0, {}});
  CHECK(iterator.next(1s).selection.explores);
  CHECK_FALSE(iterator.next(900ms).selection.explores);
}

TEST_CASE("a strategy that is not there is refused with those that are") {
  CHECK_THROWS_AS(StrategyFactory().make("learnt"), InvalidArgument);
  CHECK_THROWS_WITH(StrategyFactory().make("learnt"),
                    Catch::Contains("did you mean 'learned'") && Catch::Contains("fixed_order"));
}

namespace {

/// An algorithm of the simulation: what it takes depends on the request's size, and on the day.
struct Algorithm {
  std::string name;
  double factor_ms;
  double power;
  double took_ms(double size, double noise) const {
    return factor_ms * std::pow(size, power) * noise;
  }
};

/// PAR10 of one request: its time, or ten times the limit where that passed.
double par10(double took_ms, double limit_ms) {
  return took_ms <= limit_ms ? took_ms : 10 * limit_ms;
}

struct Scores {
  double virtual_best = 0, selector = 0;
  std::map<std::string, double> single;
  double gap_closed() const {
    double single_best = INFINITY;
    for (const auto& [name, score] : single) single_best = std::min(single_best, score);
    return (single_best - selector) / (single_best - virtual_best);
  }
};

/// Runs requests through selection and history as a Head does, with invented times.
class Simulation {
 public:
  explicit Simulation(unsigned seed) : random_(seed) {}

  std::vector<Algorithm> algorithms{{"linear", 1, 1}, {"steady", 60, 0}, {"quadratic", 0.02, 2}};

  void run(int requests, Scores& scores) {
    for (int i = 0; i < requests; ++i) request(scores);
  }

 private:
  void request(Scores& scores) {
    const double size = std::exp(std::uniform_real_distribution<double>(0, 6)(random_));
    const double limit_ms = std::exp(std::uniform_real_distribution<double>(4, 8)(random_));
    std::map<std::string, double> times;
    std::lognormal_distribution<double> noise(0, 0.1);
    double best = INFINITY;
    for (const Algorithm& each : algorithms) {
      times[each.name] = each.took_ms(size, noise(random_));
      scores.single[each.name] += par10(times[each.name], limit_ms);
      best = std::min(best, times[each.name]);
    }
    scores.virtual_best += par10(best, limit_ms);
    scores.selector += par10(selected(size, limit_ms, times), limit_ms);
  }

  double selected(double size, double limit_ms, const std::map<std::string, double>& times) {
    const Features features{{"size", size}};
    std::vector<Candidate> candidates;
    for (const Algorithm& each : algorithms) {
      candidates.push_back(
          candidate(each.name, 50ms, 1, history_.predict("x", each.name, features)));
    }
    CandidateIterator iterator(*strategy_, candidates,
                               {features, {}, 0.02, history_.decisions("x")});
    double spent_ms = 0;
    bool explored = false, accepted = false;
    while (!accepted && !iterator.done() && spent_ms < limit_ms) {
      const auto [chosen, choice] = iterator.next(ms(limit_ms - spent_ms));
      explored = explored || choice.explores;
      const Duration took = std::min(ms(times.at(chosen.name)), choice.slice);
      accepted = ms(times.at(chosen.name)) <= choice.slice;
      history_.add("x", chosen.name, {features, took, accepted, !accepted, {}, 0});
      spent_ms += std::chrono::duration<double, std::milli>(took).count();
    }
    history_.count("x", explored);
    return accepted ? spent_ms : INFINITY;
  }

  static Duration ms(double value) {
    return std::chrono::duration_cast<Duration>(std::chrono::duration<double, std::milli>(value));
  }

  const std::shared_ptr<const SelectionStrategy> strategy_ = make_learned_selection();
  std::mt19937 random_;
  History history_;
};

}  // namespace

TEST_CASE(
    "after learning the selector closes four fifths of the gap between the best CSP and the best "
    "choice") {
  Scores before_drift, after_drift, learning;
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    Simulation simulation(seed);
    simulation.run(1000, learning);
    simulation.run(1000, before_drift);
    simulation.algorithms = {{"linear", 0.3, 1}, {"steady", 20, 0}, {"quadratic", 0.05, 2}};
    simulation.run(1000, learning);
    simulation.run(1000, after_drift);
  }
  CHECK(before_drift.gap_closed() >= 0.8);
  CHECK(after_drift.gap_closed() >= 0.8);
}
