#pragma once

#include <condition_variable>
#include <optional>

#include "head_state.hpp"

namespace skein {

/// One request on its way through the Head, on the caller's thread.
class Head::Run {
 public:
  /// All references outlive the run. `record` says what the strategy is told of the request.
  Run(State& state, const InterfaceInfo& interface, const SelectionStrategy& strategy,
      task_run::TaskRun& task, const std::vector<Candidate>& candidates,
      introspection::Decision& record, Instant begin);

  /// Until there is a result, no CSP is left, or the time is up. Whether there is a result.
  bool run();

  /// Throws why there is none.
  [[noreturn]] void fail() const;

 private:
  /// One CSP at work.
  struct Live {
    std::size_t attempt;  // index into the record's
    Candidate candidate;
    std::uint64_t run;
    std::unique_ptr<task_run::Work> work;
    std::shared_ptr<Channel> channel;
  };

  /// Where the caller's thread waits for several CSPs.
  class Bell {
   public:
    void ring();
    void await();

   private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool rung_ = false;
  };

  Instant now() const { return state_.parts.clock.now(); }
  void run_all();
  bool begin_another();
  bool look_again();
  std::vector<Candidate> joined();
  bool await_return(std::uint64_t seen);
  bool may_have_another_turn(const std::string& csp) const;
  void begin(CandidateIterator::Next next, Instant began);
  void await();
  void judge_ready();
  void note(Live& live, task_run::Verdict verdict);
  void conclude_if_enough();
  /// Fewer results are accepted than the task asks for.
  bool too_few() const;
  void note_too_few();
  void cancel_rest();
  bool waits_for_late_ones() const;
  std::string in_vain() const;

  State& state_;
  const InterfaceInfo& interface_;
  task_run::TaskRun& task_;
  introspection::Decision& record_;
  const Instant begin_;
  const Instant deadline_;
  const SelectionStrategy& strategy_;
  const std::shared_ptr<const Features> features_;
  CandidateIterator iterator_;
  std::uint32_t round_ = 0;
  std::vector<Live> live_;
  std::optional<Instant> late_at_;
  std::shared_ptr<Bell> bell_;  // once several work at a time
  entity::LostCsps lost_;
  bool waited_ = false;  // for a CSP that was lost, in vain
  task_run::Verdict last_;
  std::string last_csp_;  // whose that was; empty where none could be asked
  bool done_ = false;
  bool settled_ = false;
};

}  // namespace skein
