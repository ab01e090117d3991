#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <string>

namespace skein::test {

/// What became of one call.
struct CallRecord {
  bool begun = false;
  int executions = 0;
  /// Its caller had been told its end, and then something stood in the way; it was executed after
  /// that.
  bool executed_after_end = false;
  std::string outcome;  ///< "Ok", "Wrong" (another's result), an error's code, or "Killed" with its
                        ///< caller; empty until it ends.
  std::int64_t overdue_us = 0;  ///< From its deadline to its end; negative where it ended earlier.
};

/// What clients and providers in several processes do, call by call, in one file in memory. It goes
/// with the process that made it, and outlives all others. Writing is thread-safe.
class Journal {
 public:
  Journal();
  /// One that another process made, as place() gave it.
  explicit Journal(const std::string& place);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  std::string place() const;

  void begin(std::uint64_t number) { write("begin", number); }
  void execute(std::uint64_t number) { write("execute", number); }
  void end(std::uint64_t number, const std::string& outcome, std::int64_t overdue_us) {
    write("end", number, outcome, overdue_us);
  }
  /// Something that stood in the way is about to go: what has ended by now must not be executed any
  /// more.
  void mark() { write("mark", 0); }
  /// A caller's process is dead: its calls' numbers are `number << 48` and up.
  void bury(std::uint64_t number) { write("bury", number); }

  std::map<std::uint64_t, CallRecord> read() const;
  /// Of all calls; reads what is new since it was last asked.
  std::size_t executions() const;
  /// Calls that ended so.
  std::size_t count(const std::string& outcome) const;

 private:
  void write(const char* what, std::uint64_t number, const std::string& outcome = "-",
             std::int64_t overdue_us = 0);

  int descriptor_;
  mutable off_t counted_to_ = 0;
  mutable std::size_t executions_ = 0;
};

}  // namespace skein::test
