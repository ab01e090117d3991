#include "check_calls.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>

#include "test/tools/invariant.hpp"

namespace skein::test {

void check_calls(const Journal& journal, const std::string& cell,
                 const std::set<std::string>& outcomes, int max_late) {
  std::map<std::string, int> counts;
  int unresolved = 0, strange = 0, twice = 0, late = 0, unexecuted = 0, refused_and_executed = 0;
  std::int64_t overdue_us = 0;
  for (const auto& [number, call] : journal.read()) {
    ++counts[call.outcome.empty() ? "unresolved" : call.outcome];
    unresolved += call.outcome.empty() ? 1 : 0;
    strange += call.begun && outcomes.contains(call.outcome) ? 0 : 1;
    twice += call.executions > 1 ? 1 : 0;
    late += call.executed_after_end && call.outcome == "TimedOut" ? 1 : 0;
    unexecuted += call.outcome == "Ok" && call.executions == 0 ? 1 : 0;
    const bool refused = call.outcome == "Unavailable" || call.outcome == "Overloaded";
    refused_and_executed += refused && call.executions > 0 ? 1 : 0;
    if (call.outcome != "Ok") overdue_us = std::max(overdue_us, call.overdue_us);
  }
  std::string line = cell + ":";
  for (const auto& [outcome, count] : counts) line += " " + outcome + " " + std::to_string(count);
  std::printf("%s; the latest error %.1f ms after its deadline\n", line.c_str(),
              static_cast<double>(overdue_us) / 1000);
  std::fflush(stdout);
  INFO(line);
  INVARIANT(unresolved == 0);
  CHECK(strange == 0);
  INVARIANT(twice == 0);
  CHECK(late <= max_late);
  INVARIANT(unexecuted == 0);
  INVARIANT(refused_and_executed == 0);
}

}  // namespace skein::test
