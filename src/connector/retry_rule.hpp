#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "provider_connection.hpp"
#include "retry_budget.hpp"

namespace skein::connector {

/// By whom a call was tried.
struct Asked {
  Guid provider;
  std::weak_ptr<Channel> channel;
};

/// Decides if, when and at which provider a call is tried again. FailoverChannel carries that out
/// for a caller that waits, WaitingCall and RetryingCall for all other and for hedged calls.
///
/// - Not sent: the connection ended before. The call is made elsewhere at once, repeatable or not,
///   unless the client's own side has ended; FailoverChannel itself decides that.
/// - Sent, and not repeatable: its outcome is the answer, also if that is a failure.
/// - Sent, and repeatable: admit() after a failure, hedge() while the first provider is slow.
/// - No provider stands that may be asked: the call waits for one until its deadline, unless a
///   provider that stands has failed it (see wanted_after()). none_found() is how that ends.
///
/// It has no clock and no lock. One thread at a time uses it; answered() and not_hedged() may come
/// from any. hedge() and not_hedged() only if hedge_after() is set.
class RetryRule {
 public:
  /// Whether the operation may run twice.
  static bool repeats(const OperationInfo& operation) {
    return operation.idempotent && !operation.oneway;
  }

  RetryRule(const OperationInfo& operation, Instant deadline,
            const std::shared_ptr<RetryBudget>& budget, const std::optional<Duration>& hedge_after)
      : deadline_(deadline) {
    if (!repeats(operation)) return;
    budget_ = budget;
    hedge_after_ = hedge_after;
    budget_->earn();
  }

  /// Whether another provider may do what that one failed to do; one does already where
  /// `others_run`. What was lost with a provider is repeated once in any case, and never again:
  /// the request itself may be what ended them, and `error` says so then. What a provider refused
  /// as it was about to go is repeated once in any case, too; what a full one refused, and all
  /// further repeats, within the budget.
  bool admit(std::exception_ptr& error, const Asked& failed, Instant now, bool others_run = false);

  /// How long the first provider has the call alone; nothing if no second one is asked.
  const std::optional<Duration>& hedge_after() const noexcept { return hedge_after_; }
  /// Whether it may be made at a second provider while the first one has it.
  bool hedge() noexcept { return budget_->take(); }
  /// No second provider was there to take it.
  void not_hedged() noexcept { budget_->give_back(1); }

  /// The call was answered: what had been refused was no load, and is not paid for.
  void answered() noexcept {
    if (refused_ > 0) budget_->give_back(refused_.exchange(0));
  }

  /// How a call ends for which no provider was found, `lack` being why: with its last provider's
  /// failure, if it had one. The text says so if it `waited` for another.
  std::exception_ptr none_found(const std::exception_ptr& lack, bool waited);

  struct Failure {
    Asked asked;
    bool refused;
  };
  using Failures = std::vector<Failure>;
  const Failures& failures() const noexcept { return failures_; }

 private:
  bool admit_loss(std::exception_ptr& error);

  const Instant deadline_;
  std::shared_ptr<RetryBudget> budget_;  // null: not repeatable
  std::optional<Duration> hedge_after_;
  Failures failures_;
  std::exception_ptr why_;  // the failure after which it is to be repeated
  bool lost_ = false;       // and repeated
  int repeats_ = 0;
  std::atomic<int> refused_{0};  // and paid for
};

/// Who is to be asked next; before the first failure, anybody who comes. A provider that refused,
/// or whose connection stands, so that it answered with the failure itself, is not asked again, and
/// as long as one stands nobody is waited for. One that was lost may be asked where nobody else is
/// available. Not under a lock that a call's end takes: it may be the last to hold a connection.
ProviderQuery wanted_after(const RetryRule::Failures& failures, Instant deadline);

/// As wanted_after(), for a hedge: it goes to none that was `tried`, and waits for nobody.
ProviderQuery wanted_beside(const std::vector<Guid>& tried, const RetryRule::Failures& failures,
                            Instant deadline);

}  // namespace skein::connector
