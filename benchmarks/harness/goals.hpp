#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/comparison.hpp"

/// What the project wants to reach: all limits stand in goals.cpp and here.
namespace skein::benchmarks {

/// Promises that are times, in microseconds: rivals with one sample.
inline constexpr double kCallInProcessUs = 1;
inline constexpr double kSpinningCallUs = 1;
inline constexpr double kLendingUs = 50;
inline constexpr double kIdleOctets = 65'536;
inline constexpr double kHeadUs = 2;
inline constexpr double kLearnedDecisionUs = 20;
inline constexpr double kLookUpUs = 1;
inline constexpr double kToldOnOneHostUs = 20'000;
inline constexpr double kToldBeyondLeaseUs = 50'000;
inline constexpr double kOverdueUs = 50'000;
inline constexpr double kHealedUs = 2'000'000;
inline constexpr double kLateAnswerUs = 5'000;

/// Has goals of its own, though it stands beside other middleware, too.
inline constexpr const char* kCallThroughSharedMemory = "a call through shared memory";

inline constexpr const char* kCallThatLends = "a call that lends";
inline constexpr const char* kHungUpClaim = "provider of shared memory killed to caller told";
inline constexpr const char* kIdleMemory = "memory of an idle connection, both sides";

/// One goal, and the comparisons that it speaks of.
struct Goal {
  /// Where the project wants to be in the end: the report says how far it is, and does not call it
  /// missed.
  enum class Kind { Promise, Aim };
  std::string text;
  std::function<bool(const Comparison&)> covers;
  Kind kind = Kind::Promise;
  double p50 = 1;  ///< The greatest ratio.
  std::optional<double> p99{};
};

const std::vector<Goal>& goals();

/// Writes its goal and limits into each comparison that a goal covers.
void set_goals(std::vector<Comparison>& comparisons);

/// Of a measured comparison with a goal.
bool meets_goal(const Comparison& comparison);

struct Verdict {
  const Goal* goal = nullptr;
  std::size_t measured = 0;
  std::size_t met = 0;
  std::size_t failed = 0;  ///< Should have been measured, and were not: then the goal is not met.
  const Comparison* worst =
      nullptr;  ///< The furthest beyond, or the nearest to its limits; none measured: null.
};

/// By everything that should have been measured; what was skipped does not count.
bool is_met(const Verdict& verdict);

/// One for each goal, in their order. The comparisons must stay.
std::vector<Verdict> judge(const std::vector<Comparison>& comparisons);

/// All goals in Markdown, as README quotes them: the worst comparison of each, and the verdict.
std::string goals_table(const std::vector<Comparison>& comparisons);

}  // namespace skein::benchmarks
