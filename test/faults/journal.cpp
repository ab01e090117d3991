#include "journal.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <stdexcept>
#include <string_view>

namespace skein::test {

Journal::Journal() : descriptor_(memfd_create("journal", MFD_CLOEXEC)) {
  if (descriptor_ < 0 || fcntl(descriptor_, F_SETFL, O_APPEND) != 0)
    throw std::runtime_error("no journal");
}

Journal::Journal(const std::string& place)
    : descriptor_(open(place.c_str(), O_RDWR | O_APPEND | O_CLOEXEC)) {
  if (descriptor_ < 0) throw std::runtime_error("no journal at " + place);
}

Journal::~Journal() { close(descriptor_); }

std::string Journal::place() const {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(descriptor_);
}

// One write() a line: lines of several processes do not mix, and what was written outlives a killed
// one.
void Journal::write(const char* what, std::uint64_t number, const std::string& outcome,
                    std::int64_t overdue_us) {
  const std::string line = std::string(what) + ' ' + std::to_string(number) + ' ' + outcome + ' ' +
                           std::to_string(overdue_us) + '\n';
  if (::write(descriptor_, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    std::abort();
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
    if (what == "bury") {
      for (auto& [call_number, call] : calls)
        if (call_number >> 48 == number && call.outcome.empty()) call.outcome = "Killed";
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
  char buffer[4096];
  for (ssize_t size; (size = pread(descriptor_, buffer, sizeof buffer, counted_to_)) > 0;) {
    std::string_view text(buffer, static_cast<std::size_t>(size));
    text = text.substr(0, text.rfind('\n') + 1);
    counted_to_ += static_cast<off_t>(text.size());
    for (; !text.empty(); text.remove_prefix(text.find('\n') + 1))
      executions_ += text.starts_with("execute");
  }
  return executions_;
}

std::size_t Journal::count(const std::string& outcome) const {
  std::size_t count = 0;
  for (const auto& [number, call] : read()) count += call.outcome == outcome ? 1 : 0;
  return count;
}

}  // namespace skein::test
