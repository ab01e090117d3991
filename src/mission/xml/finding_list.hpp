#pragma once

#include <set>
#include <string>
#include <vector>

#include "mission/xml/finding.hpp"

namespace skein::profile {

/// Collects findings: each text once (several peers may share a component), and no more of them
/// than a person reads, so that a hostile file cannot fill the memory with complaints.
class FindingList {
 public:
  void error(const SourcePosition& where, std::string problem, std::string remedy = {});
  void warning(const SourcePosition& where, std::string problem, std::string remedy = {});
  void add(Finding finding);
  void add_all(const std::vector<Finding>& findings);

  const std::vector<Finding>& list() const noexcept { return list_; }
  /// Whether further findings are dropped; loops that make many of them end then.
  bool full() const noexcept { return list_.size() >= kMax; }
  /// Throws DescriptionError if one of the findings is an error.
  void throw_if_errors() const;

 private:
  static constexpr std::size_t kMax = 1000;
  std::vector<Finding> list_;
  std::set<std::string> seen_;
};

}  // namespace skein::profile
