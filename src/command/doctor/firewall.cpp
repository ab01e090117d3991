#include <algorithm>
#include <charconv>
#include <sstream>
#include <vector>

#include "diagnosis.hpp"

namespace skein::command::doctor {
namespace {

/// Without quotes, and with blanks for what separates words.
std::vector<std::string> words_of(std::string line) {
  for (char& c : line)
    if (c == ',' || c == ';') c = ' ';
  std::erase(line, '"');
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

bool has(const std::vector<std::string>& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}

/// `7400` or `7400-7649`; nothing for anything else.
std::optional<PortRange> range_of(const std::string& text) {
  PortRange range{};
  const char* const end = text.data() + text.size();
  std::from_chars_result read = std::from_chars(text.data(), end, range.first);
  range.last = range.first;
  if (read.ec == std::errc() && read.ptr != end && *read.ptr == '-')
    read = std::from_chars(read.ptr + 1, end, range.last);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return range;
}

enum class Coverage { None, Some, All };

/// Which of the ports a rule is about.
Coverage coverage(const std::vector<std::string>& words, PortRange ports) {
  const auto dport = std::ranges::find(words, "dport");
  if (dport == words.end()) return Coverage::All;
  Coverage most = Coverage::None;
  for (auto word = std::next(dport); word != words.end(); ++word) {
    const auto range = range_of(*word);
    if (!range) {
      if (*word == "{" || *word == "}") continue;
      break;
    }
    if (range->first <= ports.first && range->last >= ports.last) return Coverage::All;
    if (range->first <= ports.last && range->last >= ports.first) most = Coverage::Some;
  }
  return most;
}

/// Whether a rule is about UDP packets that come in there.
bool concerns(const std::vector<std::string>& words, const std::string& interface) {
  for (const char* other :
       {"tcp", "icmp", "icmpv6", "ip6", "sctp", "oif", "oifname", "established", "invalid"}) {
    if (has(words, other)) return false;
  }
  for (const char* match : {"iif", "iifname"}) {
    const auto found = std::ranges::find(words, match);
    if (found != words.end() && std::next(found) != words.end() && *std::next(found) != interface)
      return false;
  }
  return !has(words, "saddr");
}

}  // namespace

std::optional<std::string> what_blocks(const std::string& ruleset, const std::string& interface,
                                       PortRange ports) {
  std::istringstream lines(ruleset);
  bool incoming = false, passed = false;
  std::string policy;
  for (std::string line; std::getline(lines, line);) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (has(words, "hook")) {
      incoming = has(words, "input");
      passed = false;
      policy = incoming && has(words, "drop") ? "policy drop" : "";
    } else if (words.front() == "}") {
      if (incoming && !passed && !policy.empty()) return "chain of input packets: " + policy;
      incoming = false;
    } else if (incoming && !passed && concerns(words, interface)) {
      const Coverage part = coverage(words, ports);
      if (has(words, "accept") && part == Coverage::All) passed = true;
      if ((has(words, "drop") || has(words, "reject")) && part != Coverage::None)
        return line.substr(line.find_first_not_of(" \t"));
    }
  }
  return std::nullopt;
}

}  // namespace skein::command::doctor
