#include "recent_lines.hpp"

#include "core/printable.hpp"
#include "skein/detail/type_support.hpp"

namespace skein::launch {

void RecentLines::add(std::uint64_t time, const std::string& process, const std::string& system,
                      bool printed, std::string_view text) {
  lines_.push_back({++count_, time, process, system, printed, printable(text, kLongest)});
  if (lines_.size() > kKept) lines_.pop_front();
}

std::string RecentLines::json() const {
  MissionLines all;
  for (const MissionLine& line : lines_) all.lines.push_back(line);
  return idl::to_json(all);
}

}  // namespace skein::launch
