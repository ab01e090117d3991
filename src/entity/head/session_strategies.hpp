#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "skein/call_context.hpp"
#include "skein/entity.hpp"
#include "skein/selection.hpp"

namespace skein::entity {

/// Which strategy decides: the one that the caller's session has asked for, or the Head's.
/// Thread-safe.
class SessionStrategies {
 public:
  /// Throws InvalidArgument if there is no strategy of that name.
  explicit SessionStrategies(const HeadOptions& options) : default_(options.strategy) {
    for (const auto& strategy : options.strategies) strategies_.add(strategy);
    strategies_.make(default_);
  }

  void add(std::shared_ptr<const SelectionStrategy> strategy) {
    std::lock_guard lock(mutex_);
    strategies_.add(std::move(strategy));
  }

  /// For a client that asks for a strategy; empty: the Head's. Throws InvalidArgument as above.
  std::shared_ptr<Session> open(const std::string& asked) const {
    std::lock_guard lock(mutex_);
    return std::make_shared<Asked>(strategies_.make(asked.empty() ? default_ : asked));
  }

  /// For the call that this thread executes.
  std::shared_ptr<const SelectionStrategy> of_this_call() const {
    if (const CallContext* context = CallContext::current()) {
      if (const auto* asked = dynamic_cast<const Asked*>(context->session()))
        return asked->strategy;
    }
    std::lock_guard lock(mutex_);
    return strategies_.make(default_);
  }

 private:
  struct Asked final : Session {
    explicit Asked(std::shared_ptr<const SelectionStrategy> asked) : strategy(std::move(asked)) {}
    const std::shared_ptr<const SelectionStrategy> strategy;
  };

  const std::string default_;
  mutable std::mutex mutex_;
  StrategyFactory strategies_;
};

}  // namespace skein::entity
