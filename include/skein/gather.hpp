#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "skein/connector.hpp"
#include "skein/guid.hpp"

namespace skein {

/// A provider's answer: a result (std::monostate for an operation without one) or an error.
template <class Result>
struct Answer {
  Guid provider;
  std::string entity;
  std::optional<Result> result;
  std::exception_ptr error;
};

namespace detail {

/// The order in which calls end.
class Arrivals {
 public:
  void push(std::size_t call) {
    std::lock_guard lock(mutex_);
    ended_.push_back(call);
    changed_.notify_one();
  }
  std::size_t pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !ended_.empty(); });
    const std::size_t call = ended_.front();
    ended_.pop_front();
    return call;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::size_t> ended_;
};

template <class Result>
auto outcome_of(Call<Result>& call, std::exception_ptr& error) {
  using Stored = std::conditional_t<std::is_void_v<Result>, std::monostate, Result>;
  std::optional<Stored> result;
  try {
    if constexpr (std::is_void_v<Result>) {
      call.get();
      result.emplace();
    } else {
      result.emplace(call.get());
    }
  } catch (...) {
    error = std::current_exception();
  }
  return result;
}

}  // namespace detail

/// Calls all providers at once, and waits until there are `enough` results, or until all have
/// answered or reached their deadline: `gather(planners, 2, [&](auto& planner) { return
/// planner.async_plan(problem); })`. Returns the answers in order of arrival, errors included;
/// errors do not count as results. Calls that are left are cancelled. Blocks the calling thread;
/// needs no thread of the entity.
template <class Interface, class Start>
auto gather(std::vector<Connected<Interface>>& providers, std::size_t enough, Start start) {
  using ItsCall = std::invoke_result_t<Start&, typename Interface::Proxy&>;
  std::exception_ptr error;
  using Stored = typename decltype(detail::outcome_of(std::declval<ItsCall&>(), error))::value_type;

  const auto arrivals = std::make_shared<detail::Arrivals>();
  std::vector<ItsCall> calls;
  for (Connected<Interface>& provider : providers) {
    calls.push_back(start(provider.proxy));
    calls.back().notify([arrivals, index = calls.size() - 1] { arrivals->push(index); });
  }
  std::vector<Answer<Stored>> answers;
  for (std::size_t results = 0; results < enough && answers.size() < calls.size();) {
    const std::size_t index = arrivals->pop();
    Answer<Stored> answer{providers[index].provider, providers[index].entity, {}, {}};
    answer.result = detail::outcome_of(calls[index], answer.error);
    results += answer.result ? 1 : 0;
    answers.push_back(std::move(answer));
  }
  return answers;
}

}  // namespace skein
