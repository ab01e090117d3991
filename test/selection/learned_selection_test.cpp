#include <catch2/catch.hpp>

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

/// A run on each of the requests 1, 2, …: its time, or kFailed or kStopped.
constexpr Duration kFailed{-1};
constexpr Duration kStopped{-2};
constexpr Duration kStoppedAfter = 30ms;

Prediction shown(const std::vector<Duration>& times, std::optional<double> quality = {},
                 std::uint64_t idle = 0, std::uint64_t first = 1) {
  Prediction prediction;
  for (const Duration time : times) {
    const bool accepted = time >= Duration::zero();
    const bool late = time == kStopped;
    const Duration took = accepted ? time : late ? kStoppedAfter : 1ms;
    prediction.runs.push_back({first + prediction.runs.size(), 1, took, accepted, late,
                               accepted ? quality : std::nullopt});
  }
  prediction.quality = quality;
  prediction.idle = idle;
  return prediction;
}

std::vector<Duration> always(Duration time, std::size_t times = 12) {
  return std::vector<Duration>(times, time);
}

std::vector<Duration> operator+(std::vector<Duration> left, const std::vector<Duration>& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

Selection select(const std::vector<Candidate>& candidates, Duration remaining, Utility utility = {},
                 double exploration = 0, PastDecisions past = {}) {
  return make_learned_selection()->select(candidates,
                                          {{}, remaining, exploration, past, utility, {}});
}

}  // namespace

TEST_CASE("what a CSP has shown counts, not what it declares") {
  const std::vector<Candidate> two{candidate("boaster", 10ms, 0, shown(always(400ms))),
                                   candidate("honest", 500ms, 0, shown(always(50ms)))};
  CHECK(select(two, 200ms).candidate == 1);
}

TEST_CASE("that a CSP failed at once tells nothing about the others") {
  const auto gone = candidate("gone", 10ms, 0, shown(always(kStopped)));
  const std::vector<Candidate> two{candidate("bad", 10ms, 0, shown(always(kFailed))),
                                   candidate("good", 10ms, 0, shown(always(10ms)))};
  const auto after = [&](std::vector<Tried> tried) {
    return make_learned_selection()->select(two, {{}, 100ms, 0, {}, {}, std::move(tried)});
  };
  CHECK(after({{gone, 0ms}}).candidate == 1);
  CHECK(after({{gone, 0ms}}).slice == after({}).slice);
}

TEST_CASE("until it has run, a CSP is taken at its word") {
  const std::vector<Candidate> two{candidate("new", 10ms, 0.9),
                                   candidate("old", 50ms, 0.5, shown(always(50ms), 0.5))};
  const Selection selection = select(two, 400ms);
  CHECK(selection.candidate == 0);
  CHECK_THAT(selection.reason, Catch::Contains("declares 10 ms and quality 0.9") &&
                                   Catch::Contains("has not run before"));
}

TEST_CASE("a CSP whose results are rejected is selected less, however good they claim to be") {
  CHECK(select({candidate("liar", 10ms, 0.9, shown(always(kFailed, 9) + always(10ms, 3), 0.9)),
                candidate("sound", 10ms, 0.9, shown(always(20ms), 0.9))},
               1s)
            .candidate == 1);
}

TEST_CASE("a schedule is told in plain words: who first, for how long, why, and who after that") {
  const Selection selection =
      select({candidate("RRTConnect", 0ms, 0, shown(always(20ms, 9) + always(kFailed, 3))),
              candidate("AStar", 0ms, 0, shown(always(300ms, 9) + always(80ms, 3)))},
             400ms);
  CHECK(selection.candidate == 0);
  CHECK(selection.reason ==
        "RRTConnect first for 34 ms: 9 of 12 similar requests answered by then; AStar after that, "
        "because it answered 3 of the other 3");
}

TEST_CASE("among few the time is shared evenly, unless that is clearly worse") {
  const auto quick = candidate("quick", 0ms, 0, shown(always(10ms)));
  const auto other = candidate("other", 0ms, 0, shown(always(15ms)));
  CHECK(select({quick, other}, 1s).slice == 500ms);
  CHECK(select({quick}, 1s).slice == 1s);
  const auto slow = candidate("slow", 0ms, 0, shown(always(700ms)));
  CHECK(select({slow, candidate("poor", 0ms, 0, shown(always(kFailed)))}, 1s).slice > 700ms);
}

TEST_CASE("who has failed changes what the others are worth") {
  // B answers where A does not; C answers what A answers, too.
  const auto a = candidate("A", 0ms, 0, shown(always(10ms, 8) + always(kFailed, 4)));
  const auto b = candidate("B", 0ms, 0, shown(always(kFailed, 8) + always(20ms, 4)));
  const auto c = candidate("C", 0ms, 0, shown(always(20ms, 8) + always(kFailed, 4)));
  const auto strategy = make_learned_selection();
  CandidateIterator iterator(*strategy, {a, b, c}, {});
  CHECK(iterator.next(300ms).candidate.name == "A");
  CHECK(iterator.next(200ms).candidate.name == "B");
}

TEST_CASE("a run that was stopped says only that it would have taken longer") {
  const auto stopped = candidate("stopped", 0ms, 0, shown(always(kStopped)));
  const auto failed = candidate("failed", 0ms, 0, shown(always(kFailed)));
  CHECK(select({failed, stopped}, 100ms).candidate == 1);
}

TEST_CASE("quality and time count as the task says") {
  const std::vector<Candidate> two{candidate("good", 0ms, 0, shown(always(200ms), 0.9)),
                                   candidate("quick", 0ms, 0, shown(always(20ms), 0.4))};
  using Aim = Utility::Aim;
  CHECK(select(two, 1s, {Aim::BestByDeadline}).candidate == 0);
  CHECK(select(two, 1s, {Aim::AnyByDeadline}).candidate == 1);
  CHECK(select(two, 1s, {Aim::GoodEnoughSoon, 0.3}).candidate == 1);
  CHECK(select(two, 1s, {Aim::GoodEnoughSoon, 0.8}).candidate == 0);
  CHECK(select(two, 100ms, {Aim::BestByDeadline}).candidate == 1);
}

TEST_CASE("of those that are equally good the quickest is selected") {
  CHECK(select({candidate("slow", 0ms, 0, shown(always(90ms), 0.9)),
                candidate("fast", 0ms, 0, shown(always(10ms), 0.9))},
               1s)
            .candidate == 1);
}

TEST_CASE("among many a good one gets all of the time, or half where it needs little") {
  std::vector<Candidate> five;
  for (int i = 0; i < 4; ++i) five.push_back(candidate("poor", 0ms, 0, shown(always(kFailed))));
  five.push_back(candidate("good", 0ms, 0, shown(always(600ms))));
  CHECK(select(five, 1s).candidate == 4);
  CHECK(select(five, 1s).slice == 1s);
  five.front() = candidate("other", 0ms, 0, shown(always(90ms)));
  five.back() = candidate("good", 0ms, 0, shown(always(20ms)));
  CHECK(select(five, 1s).slice == 500ms);
}

TEST_CASE(
    "the CSP that has not run for longest is explored, within the budget and as long as there is "
    "time for the best after it") {
  const std::vector<Candidate> three{candidate("best", 0ms, 0, shown(always(90ms), 0.9)),
                                     candidate("stale", 0ms, 0, shown(always(20ms), 0.1, 50)),
                                     candidate("fresh", 0ms, 0, shown(always(20ms), 0.1, 5))};
  const auto explore = [&](Duration remaining, std::uint64_t made, std::uint64_t explored) {
    return select(three, remaining, {}, 0.1, {made, explored});
  };
  const Selection selection = explore(1s, 9, 0);
  CHECK(selection.explores);
  CHECK(selection.candidate == 1);
  CHECK(selection.slice == 500ms);
  CHECK_FALSE(explore(1s, 8, 0).explores);
  CHECK_FALSE(explore(1s, 18, 1).explores);
  CHECK(explore(1s, 19, 1).explores);
  CHECK(explore(150ms, 9, 0).slice < 150ms - 90ms);
  CHECK_FALSE(explore(120ms, 9, 0).explores);
}

TEST_CASE("the same arguments give the same selection, bit for bit") {
  const std::vector<Candidate> two{candidate("a", 10ms, 0.9, shown(always(9ms), 0.8)),
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
                             {candidate("a", 1ms, 0.9, shown(always(1ms), 0.9)),
                              candidate("b", 1ms, 0.5), candidate("c", 1ms, 0.5)},
                             {{}, 1s, 1.0, {}, {}, {}});
  CHECK(iterator.next(1s).selection.explores);
  CHECK_FALSE(iterator.next(900ms).selection.explores);
}

TEST_CASE("a strategy that is not there is refused with those that are") {
  CHECK_THROWS_AS(StrategyFactory().make("learnt"), InvalidArgument);
  CHECK_THROWS_WITH(StrategyFactory().make("learnt"),
                    Catch::Contains("did you mean 'learned'") && Catch::Contains("fixed_order"));
}
