#include "harness/goals.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skein::benchmarks {
namespace {

bool is_vendor_alone(const std::string& rival) {
  return rival == "raw fastdds" || rival == "raw cyclonedds";
}

/// A call to another process, over DDS or not; the others have claims of their own.
bool is_call_beside(const Comparison& comparison, const char* rival, bool shared_memory) {
  return comparison.claim != "a call in the same process" &&
         comparison.claim != kCallThroughSharedMemory && comparison.rival.starts_with(rival) &&
         comparison.subject.starts_with("skein shared memory") == shared_memory;
}

bool is_through_shared_memory(const Comparison& comparison, const char* rival) {
  return comparison.claim == kCallThroughSharedMemory && comparison.rival == rival;
}

bool is_look_up(const Comparison& comparison) {
  return comparison.claim.starts_with("find_service");
}

bool is_death(const Comparison& comparison, const char* where) {
  return comparison.claim.starts_with("provider killed") &&
         comparison.parameters.at("where") == where;
}

/// Of all scenarios of a map, as long as the map is large enough for a promise.
bool is_mean_on_grids(const Comparison& comparison, bool in_space) {
  if (comparison.claim != "a path on a grid, mean over a map" || comparison.absence) return false;
  const auto& parameters = comparison.parameters;
  const bool is_space = parameters.at("depth") > 1;
  return is_space == in_space &&
         (is_space || (parameters.at("width") >= 256 && parameters.at("height") >= 256));
}

/// Of those with experience: the other strategies stand beside them.
bool is_about_decisions(const Comparison& comparison, const char* claim) {
  return comparison.claim.starts_with(claim) && comparison.subject == "skein learned";
}

/// Of those that learned beforehand: what a Head makes of nothing stands beside them.
bool is_of_recorded(const Comparison& comparison, const std::string& what) {
  return comparison.claim.starts_with("recorded problems: " + what) &&
         comparison.subject == "skein learned" &&
         comparison.parameters.value("mode", "").starts_with("learned");
}

/// How far beyond its limits a measured comparison is: over 1 it misses them.
double strain(const Comparison& comparison) {
  const double p50 = comparison.ratio_p50() / *comparison.goal_p50;
  return comparison.goal_p99 ? std::max(p50, comparison.ratio_p99() / *comparison.goal_p99) : p50;
}

const Goal* goal_of(const Comparison& comparison) {
  const auto found =
      std::ranges::find_if(goals(), [&](const Goal& goal) { return goal.covers(comparison); });
  return found == goals().end() ? nullptr : &*found;
}

std::string judgement_of(const Verdict& verdict) {
  if (verdict.worst == nullptr) return verdict.failed > 0 ? "missed: failed" : "not measured";
  const bool aim = verdict.goal->kind == Goal::Kind::Aim;
  const char* word = is_met(verdict) ? "met" : aim ? "not yet" : "missed";
  const std::string failed = verdict.failed > 0 ? fmt::format(", {} failed", verdict.failed) : "";
  return fmt::format("{} ({} of {}{})", word, verdict.met, verdict.measured, failed);
}

/// `p50 ≤ 1.05×, p99 ≤ 1.15×`; the p99 only if the goal has one.
std::string ratios_text(const Goal& goal, const char* relation, double p50, double p99) {
  return fmt::format("p50 {}{:.2f}×", relation, p50) +
         (goal.p99 ? fmt::format(", p99 {}{:.2f}×", relation, p99) : "");
}

}  // namespace

const std::vector<Goal>& goals() {
  static const std::vector<Goal> kGoals{
      {"A call over DDS costs what a raw call does (mixed pairs: the slower vendor's)", 1.05, 1.15,
       [](const Comparison& c) {
         return c.claim == "a call over DDS" && is_vendor_alone(c.rival);
       }},
      {"A call in the same process takes at most 1 µs",
       1.0,
       {},
       [](const Comparison& c) {
         return c.claim == "a call in the same process" && c.rival.starts_with("limit");
       }},
      {"A call in the same process is ahead of omniORB's collocated call",
       1.0,
       {},
       [](const Comparison& c) { return c.rival == "omniorb collocated"; }},
      {"A Head and its dispatch add at most 2 µs to the direct call of a CSP in its process",
       1.0,
       {},
       [](const Comparison& c) { return c.claim.starts_with("Head and dispatch around"); }},
      {"A decision among four CSPs by what was learned, and its dispatch, take at most 20 µs",
       1.0,
       {},
       [](const Comparison& c) { return c.claim.starts_with("Head and dispatch with"); }},
      {"Calls to another process are ahead of omniORB",
       1.0,
       {},
       [](const Comparison& c) { return is_call_beside(c, "omniorb ", false); },
       Goal::Kind::Aim},
      {"Calls to another process are ahead of gRPC",
       1.0,
       {},
       [](const Comparison& c) { return is_call_beside(c, "grpc ", false); },
       Goal::Kind::Aim},
      {"Calls to another process are ahead of ZeroMQ",
       1.0,
       {},
       [](const Comparison& c) { return is_call_beside(c, "zeromq ", false); },
       Goal::Kind::Aim},
      {"Calls through shared memory are ahead of omniORB",
       1.0,
       {},
       [](const Comparison& c) { return is_call_beside(c, "omniorb ", true); },
       Goal::Kind::Aim},
      {"Calls through shared memory are ahead of gRPC",
       1.0,
       {},
       [](const Comparison& c) { return is_call_beside(c, "grpc ", true); },
       Goal::Kind::Aim},
      {"Calls through shared memory are ahead of ZeroMQ",
       1.0,
       {},
       [](const Comparison& c) { return is_call_beside(c, "zeromq ", true); },
       Goal::Kind::Aim},
      {"A call through shared memory takes no longer than a plain Unix socket's ping-pong",
       1.0,
       {},
       [](const Comparison& c) { return is_through_shared_memory(c, "unix socket"); },
       Goal::Kind::Aim},
      {"A call through shared memory whose both sides spin takes at most 1 µs",
       1.0,
       {},
       [](const Comparison& c) {
         return is_through_shared_memory(c, "limit 1 us") && c.parameters.contains("size_bytes");
       },
       Goal::Kind::Aim},
      {"A call that lends a mebibyte takes no longer than two copies of it",
       2.0,
       {},
       [](const Comparison& c) {
         return c.claim == kCallThatLends && c.rival == "a copy by memcpy";
       }},
      {"A call that lends 64 MiB takes at most 50 µs",
       1.0,
       {},
       [](const Comparison& c) { return c.claim == kCallThatLends && c.rival == "limit 50 us"; }},
      {"32 idle clients of the same service, and 1,000 through shared memory, cost a call nothing",
       1.05,
       {},
       [](const Comparison& c) { return c.claim == "a call beside idle clients"; }},
      {"An idle connection through shared memory takes at most 64 KiB of memory",
       1.0,
       {},
       [](const Comparison& c) { return c.claim == kIdleMemory; }},
      {"A call that is recorded costs what one does that is not", 1.05, 1.25,
       [](const Comparison& c) { return c.claim == "a call that is recorded"; }},
      {"A recording takes in 95 % of what a subscriber does that only counts",
       1 / 0.95,
       {},
       [](const Comparison& c) { return c.claim == "a topic at full speed, time per value"; }},
      {"The first reply comes as soon as a raw one after the process's start",
       1.2,
       {},
       [](const Comparison& c) { return c.claim == "process start to first reply"; }},
      {"50 peers that start at once see each other as soon as raw ones",
       1.2,
       {},
       [](const Comparison& c) { return c.claim == "peers that start at once until all see all"; }},
      {"find_service among 10 to 10,000 descriptions takes at most 1 µs, with constraints too",
       1.0,
       {},
       [](const Comparison& c) { return is_look_up(c) && c.rival.starts_with("limit"); }},
      {"find_service is ahead of omniORB's name server",
       1.0,
       {},
       [](const Comparison& c) { return is_look_up(c) && c.rival.starts_with("omniORB"); }},
      {"The death of a provider on the same host is known within 20 ms", 1.0, 1.0,
       [](const Comparison& c) { return is_death(c, "one host"); }},
      {"The death of a provider is known through shared memory as soon as that of a bare process",
       1.2,
       {},
       [](const Comparison& c) { return c.claim == kHungUpClaim; }},
      {"The death of a provider on another host is known within the lease and 50 ms", 1.0, 1.0,
       [](const Comparison& c) { return is_death(c, "across two hosts"); }},
      {"A call to a provider that was stopped ends within 50 ms of its deadline", 1.0, 1.0,
       [](const Comparison& c) { return c.claim == "deadline to its call's end"; }},
      {"2 s after a fault calls are answered and all services known again", 1.0, 1.0,
       [](const Comparison& c) { return c.claim.starts_with("a fault's end to "); }},
      {"A path on a plane of 256 x 256 cells and more takes a tenth of plain A*'s mean",
       0.1,
       {},
       [](const Comparison& c) { return is_mean_on_grids(c, false); }},
      {"A path in a space takes a fifth of plain A*'s mean",
       0.2,
       {},
       [](const Comparison& c) { return is_mean_on_grids(c, true); }},
      {"After learning, selection closes 0.8 of the gap between the single best and the virtual "
       "best",
       0.2,
       {},
       [](const Comparison& c) {
         return is_about_decisions(c, "PAR10") && c.parameters.at("where") == "held-out";
       }},
      {"On problems that others recorded, selection closes 0.3 of the gap",
       0.7,
       {},
       [](const Comparison& c) { return is_of_recorded(c, "PAR10") && c.rival == "single best"; }},
      {"On problems that others recorded, selection closes 0.6 of the gap in the mean",
       0.4,
       {},
       [](const Comparison& c) { return is_of_recorded(c, "share"); }},
      {"On problems that others recorded, selection is as good as a random forest for each "
       "algorithm",
       1.0,
       {},
       [](const Comparison& c) { return c.rival == "random forests"; }},
      {"Every result that the Head accepts is valid by an independent judge",
       1.0,
       {},
       [](const Comparison& c) { return is_about_decisions(c, "results"); }},
      {"The answer is there 5 ms after the deadline, whoever hangs", 1.0, 1.0,
       [](const Comparison& c) { return is_about_decisions(c, "deadline to the answer"); }},
  };
  return kGoals;
}

void set_goals(std::vector<Comparison>& comparisons) {
  for (Comparison& comparison : comparisons) {
    const Goal* goal = goal_of(comparison);
    if (goal == nullptr) continue;
    comparison.goal = goal->text;
    comparison.goal_p50 = goal->p50;
    comparison.goal_p99 = goal->p99;
  }
}

bool meets_goal(const Comparison& comparison) { return strain(comparison) <= 1; }

bool is_met(const Verdict& verdict) {
  return verdict.failed == 0 && verdict.met == verdict.measured;
}

std::vector<Verdict> judge(const std::vector<Comparison>& comparisons) {
  std::vector<Verdict> verdicts;
  for (const Goal& goal : goals()) {
    Verdict& verdict = verdicts.emplace_back(Verdict{&goal});
    for (const Comparison& comparison : comparisons) {
      if (goal_of(comparison) != &goal) continue;
      if (comparison.absence) {
        verdict.failed += comparison.absence.failed ? 1 : 0;
        continue;
      }
      ++verdict.measured;
      verdict.met += meets_goal(comparison) ? 1 : 0;
      if (verdict.worst == nullptr || strain(comparison) > strain(*verdict.worst))
        verdict.worst = &comparison;
    }
  }
  return verdicts;
}

std::string goals_table(const std::vector<Comparison>& comparisons) {
  std::string table = "| goal | limit | worst | comparisons that meet it |\n|---|---|---|---|\n";
  for (const Verdict& verdict : judge(comparisons)) {
    const Goal& goal = *verdict.goal;
    const Comparison* worst = verdict.worst;
    table += fmt::format("| {} | {} | {} | {} |\n", goal.text,
                         ratios_text(goal, "≤ ", goal.p50, goal.p99.value_or(0)),
                         worst ? ratios_text(goal, "", worst->ratio_p50(), worst->ratio_p99()) : "",
                         judgement_of(verdict));
  }
  return table;
}

}  // namespace skein::benchmarks
