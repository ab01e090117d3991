#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/executor.hpp"
#include "skein/head.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::entity {

/// What came of a run of a CSP.
struct Ending {
  introspection::Outcome outcome;
  Duration took;
  Duration expected;  ///< As Selection::expected.
  std::optional<double> quality;
  bool fault;
  bool settled;           ///< A refusal that is the answer.
  bool own;               ///< As Verdict::own.
  std::string reason;     ///< Of a fault, in words.
  std::uint64_t request;  ///< Its number.
  std::uint32_t after;    ///< As History::Sample::after.
};

/// What a Head has learned about its CSPs from past requests: its History, which a thread of its
/// own learns from. Thread-safe.
class HeadLearning {
 public:
  /// Reads the history from `file` if it exists; empty: no file. Throws InvalidArgument if it can
  /// be neither read nor written.
  HeadLearning(std::string entity, std::string file);
  /// Writes the history; logs an error if it cannot.
  ~HeadLearning();

  /// A request has come; returns the counts before it.
  PastDecisions begin_request(std::string_view interface);
  void predict(const InterfaceInfo& interface, const Features& features,
               std::vector<Candidate>& candidates) const;
  /// What came of a run, unless that says nothing about the CSP's time.
  void add(const InterfaceInfo& interface, const Candidate& candidate,
           const std::shared_ptr<const Features>& features, const Ending& ending);
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
