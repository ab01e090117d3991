#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <set>
#include <string>
#include <vector>

namespace skein::command {

/// Values of one topic as a table (RFC 4180), a row each: the time in seconds since 1970, and a
/// column for each member, `position.x` or `corners[2].x`. An array with more than kMostElements in
/// any value is one column of JSON: a map of cells would make a million columns.
///
/// First add() every value, then end(), then write each row. Values are JSON; what is none throws
/// InvalidArgument.
class CsvTable {
 public:
  static constexpr std::size_t kMostElements = 16;

  void add(const std::string& json);
  /// The columns are known.
  void end();
  void write_head(std::ostream& output) const;
  void write_row(std::ostream& output, std::uint64_t nanoseconds, const std::string& json) const;

 private:
  std::vector<std::string> columns_;   // in the order in which they came
  std::set<std::string> known_;        // the same
  std::set<std::string> long_arrays_;  // each of which is one column
};

}  // namespace skein::command
