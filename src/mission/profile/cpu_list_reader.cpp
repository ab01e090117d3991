#include "cpu_list_reader.hpp"

#include <algorithm>
#include <charconv>

#include "mission/xml/words.hpp"

namespace skein::profile {
namespace {

constexpr unsigned kLargestCpu = 1023;

/// `2` or `0-3`; false where the text is neither.
bool add_range(std::string_view text, std::vector<unsigned>& cpus) {
  const char* const end = text.data() + text.size();
  unsigned first = 0;
  auto result = std::from_chars(text.data(), end, first);
  if (result.ec != std::errc()) return false;
  unsigned last = first;
  if (result.ptr != end) {
    if (*result.ptr != '-') return false;
    result = std::from_chars(result.ptr + 1, end, last);
  }
  if (result.ec != std::errc() || result.ptr != end || last < first || last > kLargestCpu)
    return false;
  for (unsigned cpu = first; cpu <= last; ++cpu) cpus.push_back(cpu);
  return true;
}

}  // namespace

std::vector<unsigned> read_cpus(const XmlElement& element, const char* name) {
  const auto list = element.maybe_attribute(name);
  if (!list) return {};
  std::vector<unsigned> cpus;
  std::string_view rest = list->value;
  while (true) {
    const std::size_t comma = rest.find(',');
    if (!add_range(trimmed(rest.substr(0, comma)), cpus)) {
      element.findings().error(list->where, in_quotes(list->value) + " is no list of CPUs",
                               "write their numbers, as in \"0\" or \"0,2-3\"");
      return {};
    }
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  std::sort(cpus.begin(), cpus.end());
  cpus.erase(std::unique(cpus.begin(), cpus.end()), cpus.end());
  return cpus;
}

}  // namespace skein::profile
