#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "skein/connector/connector.hpp"
#include "skein/entity/selection.hpp"
#include "skein/rpc/service.hpp"

namespace skein {

/// One CSP's try at a task.
struct Attempt {
  enum class Outcome { Accepted, Rejected, Refused, TimedOut, Disconnected, Failed };
  std::string csp;
  Duration slice{};
  Duration took{};
  Outcome outcome = Outcome::Failed;
  std::string text;    ///< What the evaluation or the CSP said.
  std::string reason;  ///< Why it was chosen.
};

const char* to_string(Attempt::Outcome outcome) noexcept;

/// How one request was decided.
struct DecisionRecord {
  std::uint64_t number = 0;
  std::string interface;
  std::string strategy;
  Duration available{};
  std::vector<Candidate> candidates;  ///< As they stood by when the request came.
  std::vector<Attempt> attempts;      ///< In order; the last is accepted, or nothing was.
  Duration took{};
};

/// A task for whichever CSP the Head selects.
template <class Interface, class Result>
struct Task {
  /// Calls the CSP; `budget` is the time after which the answer is of no use any more. Runs on the
  /// caller's thread, once per attempt.
  std::function<Result(typename Interface::Proxy& csp, Duration budget)> run;
  /// Judges a result: nothing accepts it, a text says why it is rejected. Empty: accepts all.
  std::function<std::optional<std::string>(const Result&)> evaluate;
  /// Whether an exception that the interface declares settles the matter, so that no other CSP needs
  /// to be asked. Empty: none does.
  std::function<bool(const UserException&, const Candidate&)> settles;
  /// Only the CSP of that name; empty lets the Head choose.
  std::string only;
};

/// The deciding half of an entity: which CSP runs a task, whether its result is good enough, and what
/// to do when one fails. Candidates are what the Broker knows of the managed interface at that moment,
/// so CSPs come and go while the system runs. Thread-safe.
class Head {
 public:
  struct Current {
    std::string csp;
    std::uint32_t pid = 0;
    std::string host;
  };

  Head(Connector& connector, brokerless_discovery::Broker& broker,
       std::shared_ptr<rpc::LocalDirectory> directory, Clock& clock);

  /// Makes a strategy selectable by its name. `declared` and `fixed_order` are there from the start.
  void add_strategy(std::shared_ptr<const SelectionStrategy> strategy);

  /// A session for a client that connects (the paper's `initialize()`). Throws InvalidArgument for an
  /// unknown strategy, with the known ones.
  std::shared_ptr<Session> initialize(const rpc::OpenRequest& request) const;

  /// Runs the task on the selected CSP, then, while it fails and time is left, on the next best.
  /// The time limit is the current call's deadline, `limit` outside of any call. Throws Unavailable
  /// where no CSP stands by, TimedOut where time ran out, otherwise what the last attempt threw.
  /// `record` receives the decision, also when this throws. The session's strategy decides.
  template <class Interface, class Result>
  Result perform(const Task<Interface, Result>& task, DecisionRecord* record = nullptr,
                 Duration limit = std::chrono::seconds(60));

  /// The CSPs that work for this Head now.
  std::vector<Current> running() const;

  /// The last decisions, oldest first; 64 are kept.
  std::vector<DecisionRecord> decisions() const;

 private:
  struct Verdict {
    Attempt::Outcome outcome = Attempt::Outcome::Failed;
    std::string text;
    std::exception_ptr error;
    bool settled = false;
  };
  using Try = std::function<Verdict(std::shared_ptr<Channel>, Duration budget, const Candidate&)>;

  void decide(const InterfaceInfo& interface, const std::string& only, Duration limit, const Try& attempt,
              DecisionRecord& record);
  Verdict try_candidate(const Candidate& candidate, Duration slice, const Try& attempt);
  std::vector<Candidate> candidates(const InterfaceInfo& interface, const std::string& only) const;
  const SelectionStrategy& strategy() const;
  std::shared_ptr<Channel> channel_to(const Candidate& candidate, Duration timeout);
  void keep(const DecisionRecord& record);
  static Verdict verdict_of(std::exception_ptr error);

  Connector& connector_;
  brokerless_discovery::Broker& broker_;
  std::shared_ptr<rpc::LocalDirectory> directory_;
  Clock& clock_;
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const SelectionStrategy>> strategies_;
  std::map<Guid, std::shared_ptr<Channel>> channels_;
  std::map<std::uint64_t, Current> running_;
  std::uint64_t last_run_ = 0;
  std::uint64_t last_decision_ = 0;
  std::deque<DecisionRecord> decisions_;
};

template <class Interface, class Result>
Result Head::perform(const Task<Interface, Result>& task, DecisionRecord* record, Duration limit) {
  std::optional<Result> accepted;
  DecisionRecord own;
  decide(
      Interface::interface_info(), task.only, limit,
      [&](std::shared_ptr<Channel> channel, Duration budget, const Candidate& candidate) {
        Verdict verdict;
        try {
          typename Interface::Proxy proxy(std::move(channel), budget);
          Result result = task.run(proxy, budget);
          const auto rejection = task.evaluate ? task.evaluate(result) : std::nullopt;
          verdict.outcome = rejection ? Attempt::Outcome::Rejected : Attempt::Outcome::Accepted;
          if (rejection) {
            verdict.text = *rejection;
          } else {
            accepted = std::move(result);
          }
        } catch (const UserException& exception) {
          verdict = verdict_of(std::current_exception());
          verdict.settled = task.settles && task.settles(exception, candidate);
        } catch (...) {
          verdict = verdict_of(std::current_exception());
        }
        return verdict;
      },
      record ? *record : own);
  return std::move(*accepted);
}

}  // namespace skein
