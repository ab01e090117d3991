#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "provider_connection.hpp"
#include "retry_budget.hpp"

namespace skein::connector {

/// By whom a call was tried.
struct Asked {
  Guid provider;
  std::weak_ptr<Channel> channel;
};

/// How often, and by whom, one call to an idempotent operation may still be tried. admit() is
/// called by one thread at a time.
class RetryRule {
 public:
  RetryRule(Instant deadline, std::shared_ptr<RetryBudget> budget)
      : deadline_(deadline), budget_(std::move(budget)) {
    budget_->earn();
  }

  /// Whether another provider may do what that one failed to do; one does already where
  /// `others_run`. What was lost with a provider is repeated once in any case, and never again:
  /// the request itself may be what ended them, and `error` says so then. What a provider refused
  /// as it was about to go is repeated once in any case, too; what a full one refused, and all
  /// further repeats, within the budget.
  bool admit(std::exception_ptr& error, const Asked& failed, Instant now, bool others_run = false);

  /// Whether it may be made at a second provider while the first one has it.
  bool hedge() noexcept { return budget_->take(); }
  /// Nobody was there to make the repeat, or the hedge, that was just admitted.
  void not_made() noexcept { budget_->give_back(1); }

  /// The call was answered: what had been refused was no load, and is not paid for.
  void answered() noexcept {
    if (refused_ > 0) budget_->give_back(refused_.exchange(0));
  }

  struct Failure {
    Asked asked;
    bool refused;
  };
  using Failures = std::vector<Failure>;
  const Failures& failures() const noexcept { return failures_; }

 private:
  bool admit_loss(std::exception_ptr& error);

  const Instant deadline_;
  std::shared_ptr<RetryBudget> budget_;
  Failures failures_;
  bool lost_ = false;  // and repeated
  int repeats_ = 0;
  std::atomic<int> refused_{0};  // and paid for
};

/// Who is to be asked next; before the first failure, anybody who comes. A provider that refused,
/// or whose connection stands, so that it answered with the failure itself, is not asked again, and
/// as long as one stands nobody is waited for. One that was lost may be asked where nobody else is
/// available. Not under a lock that a call's end takes: it may be the last to hold a connection.
ProviderQuery wanted_after(const RetryRule::Failures& failures, Instant deadline);

/// The same error with more words; what is no Error stays as it is.
std::exception_ptr with_words(const std::exception_ptr& error, const std::string& words);

}  // namespace skein::connector
