#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calls/benchmarks.hpp"
#include "harness/comparison.hpp"

namespace skein::benchmarks {

/// One way to measure whatever configuration: one claim, one set of parameters.
struct Trial {
  std::string claim;
  nlohmann::json parameters;
  std::function<std::vector<double>(Running&)> take;  ///< Microseconds.
};

/// One call after the other, after some that wake the processes up.
Trial closed_loop(const std::string& claim, std::size_t size_bytes, std::size_t count);
std::vector<Trial> closed_loops(const std::string& claim, const std::vector<CallPlan::Size>& sizes);
/// Of both sides, the mean of `count` calls, one after the other.
Trial processor_time(const std::string& claim, std::size_t size_bytes, std::size_t count);
/// Calls of 64 octets at a fixed rate; a call's time starts when it should have been sent.
Trial paced(const std::string& claim, std::size_t count, std::size_t interval_us);
/// For a command to a peer: each with a space before it.
std::string words(std::initializer_list<std::size_t> numbers);

/// A promise to compare with, instead of a rival.
struct Limit {
  std::string name;
  double time_us = 0;
};

/// Configurations that are all alive and take turns at the same trials, at each of the same
/// placements.
class Contest {
 public:
  /// `name` is for the progress line.
  Contest(std::string name, std::vector<Trial> trials,
          std::vector<Placement> placements = {Placement::OneCore, Placement::OneCoreEach});
  ~Contest();

  /// Starts its processes and prepares them. One that cannot be started, is skipped, or fails then
  /// or later has no figures, and leaves the others alone.
  void enter(
      const Configuration& configuration,
      const std::function<void(Running&)>& prepare = [](Running&) {});

  /// Every contender takes every trial at every placement once a round, in a new random order.
  void run(std::size_t rounds);

  /// A comparison for each trial and placement, in one order whoever is compared; parameters tell
  /// which.
  std::vector<Comparison> compare(const std::string& subject, const std::string& rival) const;
  std::vector<Comparison> compare(const std::string& subject, const Limit& limit) const;
  /// Of each subject with its rival.
  std::vector<Comparison> compare(
      const std::vector<std::pair<std::string, std::string>>& pairs) const;

 private:
  struct Contender;
  void take_turn(Contender& contender, std::size_t trial, Placement placement);
  Outcome outcome_of(const std::string& name, std::size_t trial, Placement placement) const;
  template <class OutcomeOfRival>
  std::vector<Comparison> compared(const std::string& subject, const std::string& rival,
                                   OutcomeOfRival outcome_of_rival) const;

  const std::string name_;
  const std::vector<Trial> trials_;
  const std::vector<Placement> placements_;
  std::map<std::string, Contender> contenders_;
};

}  // namespace skein::benchmarks
