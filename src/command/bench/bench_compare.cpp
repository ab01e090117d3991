#include <cstdio>
#include <string>

#include "bench.hpp"
#include "command/commands.hpp"
#include "core/printable.hpp"
#include "core/system/whole_file.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

using bench::Rows;

constexpr std::size_t kLargestResult = std::size_t{64} << 20;

Rows load(const std::string& path) {
  Rows rows = Rows::parse(read_whole_file("the result", path, kLargestResult), nullptr, false);
  bool good = rows.is_array();
  for (const Rows& row : rows) {
    good = good && row.is_object() && row.contains("what") && row.contains("vendor") &&
           row.value("p50_us", Rows()).is_number() && row.value("p99_us", Rows()).is_number();
  }
  if (!good)
    throw InvalidArgument(path + " holds no result; save one by 'skein bench ... --output FILE'");
  return rows;
}

// The same measurement, whichever the vendor: comparing vendors is what it is for.
bool same(const Rows& one, const Rows& other) {
  return one["what"] == other["what"] &&
         one.value("payload_bytes", 0) == other.value("payload_bytes", 0);
}

std::string way_of(const Rows& row) {
  const auto transport = row.value("transport", std::string("DDS"));
  const auto vendor = row["vendor"].get<std::string>();
  return printable(transport == "DDS" ? vendor : vendor + ", " + transport);
}

void print_comparison(const Rows& before, const Rows& after) {
  const double old_p50 = before["p50_us"], new_p50 = after["p50_us"];
  const double old_p99 = before["p99_us"], new_p99 = after["p99_us"];
  std::printf("%-10s %8d  %-25s %-25s %9.1f %9.1f %7.2f %7.2f\n",
              printable(before["what"].get<std::string>()).c_str(),
              before.value("payload_bytes", 0), way_of(before).c_str(), way_of(after).c_str(),
              old_p50, new_p50, new_p50 / old_p50, new_p99 / old_p99);
}

}  // namespace

int bench_compare(const BenchCompareArguments& arguments) {
  const auto& [before, after] = arguments;
  const Rows old_rows = load(before), new_rows = load(after);
  std::size_t shared = 0;
  std::printf("%-10s %8s  %-25s %-25s %9s %9s %7s %7s\n", "what", "payload", "A", "B", "A p50 us",
              "B p50 us", "p50 x", "p99 x");
  for (const Rows& old_row : old_rows) {
    for (const Rows& new_row : new_rows) {
      if (!same(old_row, new_row)) continue;
      print_comparison(old_row, new_row);
      ++shared;
    }
  }
  if (shared == 0)
    throw InvalidArgument(before + " and " + after + " have no measurement in common");
  return 0;
}

}  // namespace skein::command
