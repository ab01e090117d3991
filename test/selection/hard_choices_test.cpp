#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "skein/detail/history.hpp"

using namespace skein;

// Problems on which taking what is usually best loses. A Head's selection and history answer 3,000
// requests one after the other, in virtual time, and learn as they go.

namespace {

constexpr double kNever = INFINITY;
constexpr double kLimitMs = 100;
constexpr int kRequests = 3000;

/// One request: what each CSP would take, in ms.
struct Request {
  Features features;
  std::vector<double> times;
};
using Problem = std::function<Request(int number, std::mt19937& random)>;

double uniform(std::mt19937& random) {
  return static_cast<double>(random()) / (static_cast<double>(std::mt19937::max()) + 1);
}

double noisy(double ms, std::mt19937& random) { return ms * (0.9 + 0.2 * uniform(random)); }

Duration ms(double value) {
  return std::chrono::round<Duration>(std::chrono::duration<double, std::milli>(value));
}

struct Result {
  double gap_closed = 0;
  int missed = 0;
};

class Simulation {
 public:
  explicit Simulation(std::shared_ptr<const SelectionStrategy> strategy)
      : strategy_(std::move(strategy)) {}

  Result run(const Problem& problem, unsigned seed) {
    std::mt19937 random(seed);
    double selected = 0, best = 0;
    std::vector<double> single;
    Result result;
    for (int number = 0; number < kRequests; ++number) {
      const Request request = problem(number, random);
      single.resize(request.times.size());
      for (std::size_t i = 0; i < single.size(); ++i) single[i] += par10(request.times[i]);
      best += par10(*std::min_element(request.times.begin(), request.times.end()));
      const double took = answer(request);
      result.missed += took == kNever;
      selected += par10(took);
    }
    const double single_best = *std::min_element(single.begin(), single.end());
    result.gap_closed = (single_best - selected) / (single_best - best);
    return result;
  }

 private:
  static double par10(double took) { return took <= kLimitMs ? took : 10 * kLimitMs; }

  // Time to an answer, or kNever.
  double answer(const Request& request) {
    const std::size_t count = request.times.size();
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i)
      names.push_back(std::string(1, static_cast<char>('A' + i)));
    std::vector<Candidate> candidates(count);
    const auto predictions = history_.predict("x", {names.begin(), names.end()}, request.features);
    for (std::size_t i = 0; i < count; ++i) {
      candidates[i].name = names[i];
      candidates[i].learned = predictions[i];
    }
    const auto past = history_.decisions("x");
    const std::uint64_t number = history_.begin("x");
    const auto features = std::make_shared<const Features>(request.features);
    CandidateIterator iterator(*strategy_, candidates, {request.features, {}, 0.02, past, {}, {}});
    double spent = 0;
    bool answered = false;
    std::uint32_t after = 0;
    while (!answered && !iterator.done() && spent < kLimitMs) {
      const auto [chosen, selection] = iterator.next(ms(kLimitMs - spent));
      if (selection.explores) history_.note_exploration("x");
      const double needs = request.times[static_cast<std::size_t>(chosen.name[0] - 'A')];
      const double slice = std::chrono::duration<double, std::milli>(selection.slice).count();
      answered = needs <= slice;
      const double took = std::min(needs, slice);
      spent += took;
      history_.add("x", chosen.name, {features, ms(took), answered, !answered, {}, number, after++},
                   chosen.learned ? &*chosen.learned : nullptr);
    }
    if (number % 50 == 0) history_.learn();
    return answered ? spent : kNever;
  }

  std::shared_ptr<const SelectionStrategy> strategy_;
  History history_;
};

Request hangs_for_a_tenth(int, std::mt19937& random) {
  const double a = uniform(random) < 0.1 ? kNever : noisy(10, random);
  return {{}, {a, a == kNever ? noisy(30, random) : kNever}};
}

Request heavy_tails(int, std::mt19937& random) {
  const auto pareto = [&] { return 3 * std::pow(1 - uniform(random), -1 / 0.7); };
  return {{}, {pareto(), pareto(), pareto()}};
}

Request abrupt_drift(int number, std::mt19937& random) {
  const bool odd = number / 500 % 2 == 1;
  return {{}, {noisy(odd ? 80 : 5, random), noisy(odd ? 5 : 80, random)}};
}

Request slow_drift(int number, std::mt19937& random) {
  const double phase = 0.5 + 0.5 * std::cos(number * 2 * M_PI / 1500);
  return {{}, {noisy(5 + 75 * phase, random), noisy(80 - 75 * phase, random), noisy(60, random)}};
}

Request hangs_by_a_feature(int, std::mt19937& random) {
  const double size = uniform(random), other = uniform(random);
  return {{{"other", other}, {"size", size}},
          {size > 0.7 ? kNever : noisy(10, random), noisy(40, random), noisy(90, random)}};
}

Request a_rare_specialist(int, std::mt19937& random) {
  const double size = uniform(random), kind = uniform(random);
  const bool special = kind < 0.02;
  return {{{"size", size}, {"kind", kind}},
          {special ? kNever : noisy(10 + 40 * size, random), special ? noisy(20, random) : kNever,
           special ? kNever : noisy(60 - 40 * size, random)}};
}

Request load_from_the_100th_on(int number, std::mt19937& random) {
  const double load = number < 100 ? 1 : 7;
  return {{}, {noisy(40 * load, random), noisy(10 * load, random)}};
}

Request by_size(int, std::mt19937& random) {
  const double size = std::exp(6 * uniform(random));
  return {{{"size", size}},
          {noisy(0.3 * size, random), noisy(30, random), noisy(0.02 * size * size, random)}};
}

}  // namespace

TEST_CASE(
    "learned closes most of the gap between the best CSP and the best choice, and misses as few as "
    "even slices do",
    "[long]") {
  struct Row {
    std::string name;
    Problem problem;
    double least;
  };
  const Row row = GENERATE(values<Row>({{"a CSP hangs for a tenth", hangs_for_a_tenth, 0.9},
                                        {"heavy tails", heavy_tails, 0.75},
                                        {"abrupt drift", abrupt_drift, 0.9}}));
  INFO(row.name);
  double gap_closed = 0;
  int missed = 0, missed_by_even_slices = 0;
  constexpr unsigned kSeeds = 4;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Result result = Simulation(make_learned_selection()).run(row.problem, seed);
    gap_closed += result.gap_closed / kSeeds;
    missed += result.missed;
    missed_by_even_slices += Simulation(make_fixed_order_selection()).run(row.problem, seed).missed;
  }
  CHECK(gap_closed >= row.least);
  CHECK(missed <= missed_by_even_slices + missed_by_even_slices / 10);
}

TEST_CASE("learned is better than the best CSP where a feature, a speciality or the day decides",
          "[long]") {
  struct Row {
    std::string name;
    Problem problem;
    double least;
  };
  const Row row = GENERATE(values<Row>({{"slow drift", slow_drift, 0.1},
                                        {"a CSP hangs by a feature", hangs_by_a_feature, 0.6},
                                        {"a rare specialist", a_rare_specialist, 0.6},
                                        {"the size decides", by_size, 0.6}}));
  INFO(row.name);
  for (unsigned seed = 1; seed <= 3; ++seed)
    CHECK(Simulation(make_learned_selection()).run(row.problem, seed).gap_closed >= row.least);
}

TEST_CASE("learned finds out who answers with all of the time when an even share is too short",
          "[long]") {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const int missed =
        Simulation(make_learned_selection()).run(load_from_the_100th_on, seed).missed;
    CHECK(missed < kRequests / 30);
  }
}
