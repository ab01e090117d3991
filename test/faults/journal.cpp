#include "journal.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <set>
#include <stdexcept>

namespace skein::test {

Journal::Journal() : descriptor_(memfd_create("journal", MFD_CLOEXEC)) {
  if (descriptor_ < 0 || fcntl(descriptor_, F_SETFL, O_APPEND) != 0) throw std::runtime_error("no journal");
}

Journal::Journal(const std::string& place)
    : descriptor_(open(place.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC)) {
  if (descriptor_ < 0) throw std::runtime_error("no journal at " + place);
}

Journal::~Journal() { close(descriptor_); }

std::string Journal::place() const {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(descriptor_);
}

// One write() a line: lines of several processes do not mix, and what was written outlives a killed one.
void Journal::write(const char* what, std::uint64_t number, const std::string& outcome,
                    std::int64_t overdue_us) {
  const std::string line = std::string(what) + ' ' + std::to_string(number) + ' ' + outcome + ' ' +
                           std::to_string(overdue_us) + '\n';
  if (::write(descriptor_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) std::abort();
}

std::map<std::uint64_t, CallRecord> Journal::read() const {
  std::map<std::uint64_t, CallRecord> calls;
  std::set<std::uint64_t> over;  // ended before the last mark
  std::set<std::uint64_t> ended;
  std::ifstream file(place());
  std::string what, outcome;
  std::uint64_t number = 0;
  std::int64_t overdue_us = 0;
  while (file >> what >> number >> outcome >> overdue_us) {
    if (what == "mark") {
      over.merge(ended);
      continue;
    }
    CallRecord& call = calls[number];
    if (what == "begin") {
      call.begun = true;
    } else if (what == "execute") {
      ++call.executions;
      call.executed_after_end |= over.contains(number);
    } else {
      call.outcome = outcome;
      call.overdue_us = overdue_us;
      ended.insert(number);
    }
  }
  return calls;
}

std::size_t Journal::executions() const {
  std::size_t count = 0;
  for (const auto& [number, call] : read()) count += static_cast<std::size_t>(call.executions);
  return count;
}

std::size_t Journal::count(const std::string& outcome) const {
  std::size_t count = 0;
  for (const auto& [number, call] : read()) count += call.outcome == outcome ? 1 : 0;
  return count;
}

void check_calls(const Journal& journal, const std::string& cell, const std::set<std::string>& outcomes) {
  std::map<std::string, int> counts;
  int strange = 0, twice = 0, late = 0, unexecuted = 0, refused_and_executed = 0;
  std::int64_t overdue_us = 0;
  for (const auto& [number, call] : journal.read()) {
    ++counts[call.outcome.empty() ? "unresolved" : call.outcome];
    strange += call.begun && outcomes.contains(call.outcome) ? 0 : 1;
    twice += call.executions > 1 ? 1 : 0;
    late += call.executed_after_end ? 1 : 0;
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
  CHECK(strange == 0);
  CHECK(twice == 0);
  CHECK(late == 0);
  CHECK(unexecuted == 0);
  CHECK(refused_and_executed == 0);
}

}  // namespace skein::test
