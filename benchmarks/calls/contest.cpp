#include "calls/contest.hpp"

#include <cstdio>

#include "command/bench/random_turns.hpp"

namespace skein::benchmarks {
namespace {

constexpr std::uint32_t kSeed = 17;

const char* text_of(Placement placement) {
  switch (placement) {
    case Placement::OneCore:
      return "both on one core";
    case Placement::OneCoreEach:
      return "one core each";
    case Placement::Anywhere:
      return "anywhere";
  }
  return "";
}

}  // namespace

struct Contest::Contender {
  std::string name;
  bool needs_a_core_each = false;
  std::optional<Running> running;
  /// Of all its trials.
  Absence absence;
  std::map<std::pair<std::size_t, Placement>, Outcome> outcomes;
};

Contest::Contest(std::string name, std::vector<Trial> trials, std::vector<Placement> placements)
    : name_(std::move(name)), trials_(std::move(trials)), placements_(std::move(placements)) {}

Contest::~Contest() = default;

void Contest::enter(const Configuration& configuration,
                    const std::function<void(Running&)>& prepare) {
  std::fprintf(stderr, "starting: %s\n", configuration.name.c_str());
  Contender& contender = contenders_[configuration.name];
  contender.name = configuration.name;
  contender.needs_a_core_each = configuration.needs_a_core_each;
  contender.absence = attempt(contender.name, [&] {
    contender.running.emplace(configuration);
    prepare(*contender.running);
  });
}

void Contest::take_turn(Contender& contender, std::size_t trial, Placement placement) {
  Outcome& outcome = contender.outcomes[{trial, placement}];
  if (contender.absence || outcome.absence) return;
  outcome.absence = attempt(contender.name, [&] {
    if (contender.needs_a_core_each && placement != Placement::OneCoreEach)
      throw Skipped("it spins: both sides need a core of their own");
    contender.running->place(placement);
    const auto measured = trials_[trial].take(*contender.running);
    outcome.samples.insert(outcome.samples.end(), measured.begin(), measured.end());
    ++outcome.rounds;
  });
  // A peer that has failed once may be dead, or answer late: no later figure of it could be
  // trusted.
  if (outcome.absence.failed) {
    contender.absence = outcome.absence;
    contender.running.reset();
  }
}

Outcome Contest::outcome_of(const std::string& name, std::size_t trial, Placement placement) const {
  const Contender& contender = contenders_.at(name);
  if (contender.absence) return {{}, contender.absence};
  return contender.outcomes.at({trial, placement});
}

void Contest::run(std::size_t rounds) {
  std::vector<std::function<void()>> turns;
  for (auto& [name, contender] : contenders_) {
    for (std::size_t trial = 0; trial < trials_.size(); ++trial) {
      for (const Placement placement : placements_) {
        turns.push_back([this, &contender = contender, trial, placement] {
          take_turn(contender, trial, placement);
        });
      }
    }
  }
  take_turns(rounds, std::move(turns), kSeed, name_);
  for (auto& [name, contender] : contenders_) contender.running.reset();
}

template <class OutcomeOfRival>
std::vector<Comparison> Contest::compared(const std::string& subject, const std::string& rival,
                                          OutcomeOfRival outcome_of_rival) const {
  std::vector<Comparison> comparisons;
  for (std::size_t trial = 0; trial < trials_.size(); ++trial) {
    for (const Placement placement : placements_) {
      Comparison comparison{trials_[trial].claim, subject, rival, trials_[trial].parameters};
      comparison.parameters["placement"] = text_of(placement);
      fill(comparison, outcome_of(subject, trial, placement), outcome_of_rival(trial, placement));
      comparisons.push_back(std::move(comparison));
    }
  }
  return comparisons;
}

std::vector<Comparison> Contest::compare(const std::string& subject,
                                         const std::string& rival) const {
  return compared(subject, rival, [&](std::size_t trial, Placement placement) {
    return outcome_of(rival, trial, placement);
  });
}

std::vector<Comparison> Contest::compare(const std::string& subject, const Limit& limit) const {
  return compared(subject, limit.name,
                  [&](std::size_t, Placement) { return Outcome{{limit.time_us}}; });
}

std::vector<Comparison> Contest::compare(
    const std::vector<std::pair<std::string, std::string>>& pairs) const {
  std::vector<Comparison> comparisons;
  for (const auto& [subject, rival] : pairs) append(comparisons, compare(subject, rival));
  return comparisons;
}

Trial closed_loop(const std::string& claim, std::size_t size, std::size_t count) {
  return {claim, {{"size_bytes", size}}, [=](Running& running) {
            running.call(size, count / 10 + 1);  // wakes the processes up
            return running.call(size, count);
          }};
}

std::vector<Trial> closed_loops(const std::string& claim,
                                const std::vector<CallPlan::Size>& sizes) {
  std::vector<Trial> trials;
  for (const auto& [size, calls] : sizes) trials.push_back(closed_loop(claim, size, calls));
  return trials;
}

Trial processor_time(const std::string& claim, std::size_t size_bytes, std::size_t count) {
  return {claim, {{"size_bytes", size_bytes}}, [=](Running& running) {
            running.call(size_bytes, count / 10 + 1);
            const double before = running.cpu_us();
            running.call(size_bytes, count);
            return std::vector{(running.cpu_us() - before) / static_cast<double>(count)};
          }};
}

std::string words(std::initializer_list<std::size_t> numbers) {
  std::string text;
  for (const std::size_t number : numbers) text += " " + std::to_string(number);
  return text;
}

Trial paced(const std::string& claim, std::size_t count, std::size_t interval_us) {
  constexpr std::size_t kSmall = 64;
  return {claim, {{"calls_per_second", 1'000'000 / interval_us}}, [=](Running& running) {
            running.call(kSmall, 10);
            return running.times("paced" + words({kSmall, count, interval_us}));
          }};
}

}  // namespace skein::benchmarks
