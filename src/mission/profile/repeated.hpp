#pragma once

#include <map>
#include <string>
#include <utility>

#include "mission/xml/finding_list.hpp"
#include "mission/xml/words.hpp"

namespace skein::profile {

/// Finds names that are given twice, and says where they were given first.
class Repeated {
 public:
  explicit Repeated(std::string kind) : kind_(std::move(kind)) {}

  void add(const std::string& name, const SourcePosition& where, FindingList& findings) {
    add(name, "", where, findings);
  }

  /// Names on several hosts do not meet.
  void add(const std::string& name, const std::string& host, const SourcePosition& where,
           FindingList& findings) {
    if (name.empty()) return;
    const auto [first, fresh] = first_.emplace(std::pair(host, name), where);
    if (fresh) return;
    findings.error(where, kind_ + " " + in_quotes(name) + " is there twice",
                   first->second == where
                       ? "each peer that count makes has it; write ${instance} in it"
                       : "the first is at " + to_text(first->second));
  }

 private:
  std::string kind_;
  std::map<std::pair<std::string, std::string>, SourcePosition> first_;
};

}  // namespace skein::profile
