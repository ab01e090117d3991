#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "running_csps.hpp"
#include "skein/executor.hpp"

namespace skein::entity {

/// A Head's experience with its CSPs: the History of past requests, and a thread of its own that
/// learns from it. Thread-safe.
class HeadLearning {
 public:
  /// Reads the history from `file` if it exists; empty: no file. Throws if it cannot be
  /// read, or could not be written.
  HeadLearning(std::string entity, std::string file);
  /// Writes the history; logs an error if it cannot.
  ~HeadLearning();

  /// A request has come; returns the counts before it.
  PastDecisions begin_request(std::string_view interface);
  void predict(const InterfaceInfo& interface, const Features& features,
               std::vector<Candidate>& candidates) const;
  /// Adds the outcome of a run, unless that says nothing about the CSP's time.
  void add(const InterfaceInfo& interface, const Candidate& candidate,
           const std::shared_ptr<const Features>& features, const RunEnding& ending);
  /// Begins to learn on the other thread if it is time to.
  void end_request(const std::string& interface, bool explored);

  History history() const;

 private:
  const std::string entity_;
  const std::string file_;
  mutable std::mutex mutex_;
  History history_;
  bool learns_ = false;
  std::unique_ptr<ThreadExecutor> learner_;  // once there is something to learn
};

}  // namespace skein::entity
