#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <utility>

#include "provider_connection.hpp"
#include "retry_budget.hpp"

namespace skein::connector {

/// How often, and by whom, one call to an idempotent operation may still be tried. admit() and
/// wanted() are called by one thread at a time.
class Retries {
 public:
  Retries(Instant deadline, std::shared_ptr<RetryBudget> budget) : budget_(std::move(budget)) {
    wanted_.deadline = deadline;
    budget_->earn();
  }

  /// Whether another provider may do what `provider` failed to do; one does already where
  /// `others_run`. Notes who failed: who refused is not asked again; who was lost may be, once
  /// more, where nobody else is available. What was lost with a provider, or refused as that was
  /// about to go, is repeated once in any case; what a full one refused, and all further repeats,
  /// within the budget.
  bool admit(const std::exception_ptr& error, const Guid& provider, Instant now,
             bool others_run = false);

  /// Whether it may be made at a second provider while the first one has it.
  bool hedge() noexcept { return budget_->take(); }
  /// Nobody was there to make the repeat, or the hedge, that was just admitted.
  void not_made() noexcept { budget_->give_back(1); }

  /// The call was answered: what had been refused was no load, and is not paid for.
  void answered() noexcept {
    if (refused_ > 0) budget_->give_back(refused_.exchange(0));
  }

  /// Who is to be asked next; before the first failure, anybody who comes.
  const ProviderQuery& wanted() const noexcept { return wanted_; }

 private:
  std::shared_ptr<RetryBudget> budget_;
  ProviderQuery wanted_;
  int failures_ = 0;
  int repeats_ = 0;
  std::atomic<int> refused_{0};  // and paid for
};

}  // namespace skein::connector
