#include "harness/goals.hpp"

#include <algorithm>
#include <cstdio>

namespace skein::benchmarks {
namespace {

using Covers = std::function<bool(const Comparison&)>;

/// Of comparisons whose claim and rival begin so.
Covers about(const char* claim, const char* rival = "") {
  return
      [=](const Comparison& c) { return c.claim.starts_with(claim) && c.rival.starts_with(rival); };
}

Covers call_beside_raw(const char* claim) {
  return [=](const Comparison& c) {
    return c.claim == claim && (c.rival == "raw fastdds" || c.rival == "raw cyclonedds");
  };
}

/// A call to another process, over DDS or not; the others have claims of their own.
Covers call_beside(const char* rival, bool shared_memory) {
  return [=](const Comparison& c) {
    return c.claim != "a call in the same process" && c.claim != kCallThroughSharedMemory &&
           c.rival.starts_with(rival) &&
           c.subject.starts_with("skein shared memory") == shared_memory;
  };
}

Covers death(const char* where) {
  return [=](const Comparison& c) {
    return c.claim.starts_with("provider killed") && c.parameters.at("where") == where;
  };
}

/// Of all scenarios of a map, as long as the map is large enough for a promise.
Covers mean_on_grids(bool in_space) {
  return [=](const Comparison& c) {
    if (c.claim != "a path on a grid, mean over a map" || c.absence) return false;
    const bool is_space = c.parameters.at("depth") > 1;
    return is_space == in_space &&
           (is_space || (c.parameters.at("width") >= 256 && c.parameters.at("height") >= 256));
  };
}

/// Of those with experience: the other strategies stand beside them.
Covers decisions(const char* claim, const char* where = nullptr) {
  return [=](const Comparison& c) {
    return c.claim.starts_with(claim) && c.subject == "skein learned" &&
           (where == nullptr || c.parameters.at("where") == where);
  };
}

/// Of those that learned beforehand: what a Head makes of nothing stands beside them.
Covers recorded(const std::string& what) {
  return [=](const Comparison& c) {
    return c.claim.starts_with("recorded problems: " + what) && c.subject == "skein learned" &&
           c.rival == "single best" && c.parameters.value("mode", "").starts_with("learned");
  };
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
  return std::string(word) + " (" + std::to_string(verdict.met) + " of " +
         std::to_string(verdict.measured) +
         (verdict.failed > 0 ? ", " + std::to_string(verdict.failed) + " failed)" : ")");
}

/// `p50 ≤ 1.05×, p99 ≤ 1.15×`; the p99 only if the goal has one.
std::string ratios_text(const Goal& goal, const char* relation, double p50, double p99) {
  char text[64];
  std::snprintf(text, sizeof text, goal.p99 ? "p50 %s%.2f×, p99 %s%.2f×" : "p50 %s%.2f×", relation,
                p50, relation, p99);
  return text;
}

}  // namespace

const std::vector<Goal>& goals() {
  using enum Goal::Kind;
  static const std::vector<Goal> kGoals{
      {"A call over DDS costs what a raw call does (mixed pairs: the slower vendor's)",
       call_beside_raw("a call over DDS"), Promise, 1.05, 1.15},
      {"A call over DDS takes the processor time of a raw call (mixed pairs: the slower vendor's)",
       call_beside_raw("processor time of a call over DDS"), Promise, 1.1},
      {"A call in the same process takes at most 1 µs",
       about("a call in the same process", "limit")},
      {"A call in the same process is ahead of omniORB's collocated call",
       about("", "omniorb collocated")},
      {"A Head and its dispatch add at most 2 µs to the direct call of a CSP in its process",
       about("Head and dispatch around")},
      {"A decision among four CSPs by what was learned, and its dispatch, take at most 20 µs",
       about("Head and dispatch with")},
      {"Calls to another process are ahead of omniORB", call_beside("omniorb ", false), Aim},
      {"Calls to another process are ahead of gRPC", call_beside("grpc ", false), Aim},
      {"Calls to another process are ahead of ZeroMQ", call_beside("zeromq ", false), Aim},
      {"Calls through shared memory are ahead of omniORB", call_beside("omniorb ", true), Aim},
      {"Calls through shared memory are ahead of gRPC", call_beside("grpc ", true), Aim},
      {"Calls through shared memory are ahead of ZeroMQ", call_beside("zeromq ", true), Aim},
      {"A call through shared memory takes no longer than a plain Unix socket's ping-pong",
       about(kCallThroughSharedMemory, "unix socket"), Aim},
      {"A call through shared memory whose both sides spin takes at most 1 µs",
       [](const Comparison& c) {
         return about(kCallThroughSharedMemory, "limit 1 us")(c) &&
                c.parameters.contains("size_bytes");
       },
       Aim},
      {"A call that lends a mebibyte takes no longer than two copies of it",
       about(kCallThatLends, "a copy by memcpy"), Promise, 2.0},
      {"A call that lends 64 MiB takes at most 50 µs", about(kCallThatLends, "limit 50 us")},
      {"32 idle clients of the same service, and 1,000 through shared memory, cost a call nothing",
       about("a call beside idle clients"), Promise, 1.05},
      {"An idle connection through shared memory takes at most 64 KiB of memory",
       about(kIdleMemory)},
      {"A call that is recorded costs what one does that is not", about("a call that is recorded"),
       Promise, 1.05, 1.25},
      {"A recording takes in 95 % of what a subscriber does that only counts",
       about("a topic at full speed, time per value"), Promise, 1 / 0.95},
      {"The first reply comes as soon as a raw one after the process's start",
       about("process start to first reply"), Promise, 1.2},
      {"50 peers that start at once see each other as soon as raw ones",
       about("peers that start at once until all see all"), Promise, 1.2},
      {"find_service among 10 to 10,000 descriptions takes at most 1 µs, with constraints too",
       about("find_service", "limit")},
      {"find_service is ahead of omniORB's name server", about("find_service", "omniORB")},
      {"The death of a provider on the same host is known within 20 ms", death("one host"), Promise,
       1.0, 1.0},
      {"The death of a provider is known through shared memory as soon as that of a bare process",
       about(kHungUpClaim), Promise, 1.2},
      {"The death of a provider on another host is known within the lease and 50 ms",
       death("across two hosts"), Promise, 1.0, 1.0},
      {"A call to a provider that was stopped ends within 50 ms of its deadline",
       about("deadline to its call's end"), Promise, 1.0, 1.0},
      {"2 s after a fault calls are answered and all services known again",
       about("a fault's end to "), Promise, 1.0, 1.0},
      {"A path on a plane of 256 x 256 cells and more takes a tenth of plain A*'s mean",
       mean_on_grids(false), Promise, 0.1},
      {"A path in a space takes a fifth of plain A*'s mean", mean_on_grids(true), Promise, 0.2},
      {"After learning, selection closes 0.8 of the gap between the single best and the virtual "
       "best",
       decisions("PAR10", "held-out"), Promise, 0.2},
      {"On problems that others recorded, selection closes 0.3 of the gap", recorded("PAR10"),
       Promise, 0.7},
      {"On problems that others recorded, selection closes 0.6 of the gap in the mean",
       recorded("share"), Promise, 0.4},
      {"On problems that others recorded, selection is as good as a random forest for each "
       "algorithm",
       about("", "random forests")},
      {"Every result that the Head accepts is valid by an independent judge", decisions("results")},
      {"The answer is there 5 ms after the deadline, whoever hangs",
       decisions("deadline to the answer"), Promise, 1.0, 1.0},
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
    table += "| " + goal.text + " | " + ratios_text(goal, "≤ ", goal.p50, goal.p99.value_or(0)) +
             " | " + (worst ? ratios_text(goal, "", worst->ratio_p50(), worst->ratio_p99()) : "") +
             " | " + judgement_of(verdict) + " |\n";
  }
  return table;
}

}  // namespace skein::benchmarks
