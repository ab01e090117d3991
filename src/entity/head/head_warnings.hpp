#pragma once

#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "skein/detail/history.hpp"
#include "skein/detail/operation.hpp"
#include "skein/task.hpp"

namespace skein::entity {

/// Logs a Head's warnings about its CSPs once, and not at each request. Thread-safe. A thread that
/// holds the lock of another part may call it.
class HeadWarnings {
 public:
  explicit HeadWarnings(std::string entity) : entity_(std::move(entity)) {}

  /// `text` follows the CSP's name. Logs nothing if the last text about this CSP was the same.
  void tell(std::string_view interface, const std::string& csp, const std::string& text);
  /// Once for each interface: its CSPs do not work at a time, since `run` waits for each.
  void tell_waiting(const InterfaceInfo& interface, const TaskOptions& task);
  /// Once for each interface, if the task asks for more results than there are CSPs.
  void tell_too_few(const InterfaceInfo& interface, const TaskOptions& task, std::size_t csps);

 private:
  const std::string entity_;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::string, ByCsp> told_;  // last, of each CSP
  std::set<const InterfaceInfo*> told_waiting_;
  std::set<const InterfaceInfo*> told_too_few_;
};

}  // namespace skein::entity
