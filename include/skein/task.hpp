#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "skein/call.hpp"
#include "skein/clock.hpp"
#include "skein/error.hpp"
#include "skein/evaluation.hpp"
#include "skein/selection.hpp"
#include "skein/stream.hpp"

namespace skein {

/// How many CSPs work on a task at a time.
enum class Execution {
  One,        ///< The next begins when one has failed or used up its time slice.
  Staggered,  ///< The next also begins when the last is late; all continue.
  All,        ///< All begin at once.
};

const char* to_string(Execution execution) noexcept;

/// What a task's `run` returns: a call; a stream, whose last result counts (also if the time is up
/// before its end); or, if it waited itself, the result.
template <class Result>
class Awaited {
 public:
  Awaited(Result result) : source_(std::move(result)) {}
  Awaited(Call<Result> call) : source_(std::move(call)) {}
  Awaited(Stream<Result> stream) : source_(std::move(stream)) {}

  /// Whether get() would return at once.
  bool ready();
  /// Whether it is a result that was waited for before.
  bool waited() const { return std::holds_alternative<Result>(source_); }

  /// Runs `action` when ready() should be asked again, as Call::notify() does. Call it once for
  /// each false ready().
  void notify(std::function<void()> action);

  /// Waits for the result, or throws the error that ended the call.
  Result get();

 private:
  bool take_next(Stream<Result>& stream);

  std::variant<Result, Call<Result>, Stream<Result>> source_;
  bool watched_ = false;
  bool ended_ = false;
  std::optional<Result> last_;
  std::exception_ptr error_;
};

/// The part of a task that does not depend on its types.
struct TaskOptions {
  /// The request's name in the record.
  std::string request{};
  /// Only the CSP with this name; empty: the Head chooses.
  std::string only{};
  /// Properties of the request that may matter for the choice: finite numbers, each named once.
  Features features{};
  /// What the result is worth, for `learned`.
  Utility utility{};
  Execution execution = Execution::One;
  /// Maximum number of CSPs that work at a time; 1 or more.
  std::size_t width = SIZE_MAX;
  /// Number, 1 or more, of accepted results with which a synthesis is tried; kAll: waits for every
  /// CSP that began, until the time is up. If no CSP is left, or the time is up, it is tried with
  /// the results that there are.
  std::size_t enough = 1;
  static constexpr std::size_t kAll = SIZE_MAX;
};

/// The function that calls the CSP: a std::function, but for the words with which it refuses what
/// is called otherwise.
template <class Interface, class Result>
class TaskFunction
    : public std::function<Awaited<Result>(typename Interface::Proxy& csp, Duration budget)> {
  using Base = std::function<Awaited<Result>(typename Interface::Proxy&, Duration)>;

 public:
  TaskFunction() = default;
  // Not by `using Base::Base`, whose templates clang 14 does not find.
  template <class Other>
  requires(std::is_constructible_v<Base, Other> &&
           !std::is_same_v<std::remove_cvref_t<Other>, TaskFunction>) TaskFunction(Other&& function)
      : Base(std::forward<Other>(function)) {}
  template <class Other>
  requires(!std::is_constructible_v<Base, Other>) TaskFunction(Other&&) {
    static_assert(std::is_void_v<Other>,
                  "a task's `run` is called with the CSP's Proxy and the Duration that it has: "
                  "[](Interface::Proxy& csp, Duration budget); it returns the Result, or a Call or "
                  "a Stream of it");
  }
};

/// A task for a CSP that the Head selects. Its functions run on the thread that performs it.
///
/// ```cpp
/// skein::Task<survey::IPlanner, survey::Track> task;
/// task.request = "track";
/// task.features = {{"area_m2", area_m2}};
/// task.run = [&](survey::IPlanner::Proxy& planner, skein::Duration) {
///   return planner.plan(area);
/// };
/// ```
template <class Interface, class Result>
struct Task : TaskOptions {
  /// Required. Calls the CSP by its proxy, whose calls time out after `budget`. With several CSPs
  /// at a time it must not wait, but return what an `async_` function returned: else they work one
  /// after the other, which is logged.
  TaskFunction<Interface, Result> run{};
  Evaluation<Result> evaluate{};
  /// Whether an exception that the interface declares is final, so that no other CSP is asked.
  /// Empty: never.
  std::function<bool(const UserException&, const Candidate&)> settles{};
  /// The quality of an accepted result, for the history: on the scale of the attribute `quality`; 0
  /// is worthless.
  std::function<double(const Result&)> quality{};
  /// Makes one result from the accepted ones, when there are `enough` and again at each further one
  /// until it returns a result. Empty: the best by `quality`, or the first.
  Synthesis<Result> synthesis{};
};

template <class Result>
bool Awaited<Result>::ready() {
  if (auto* call = std::get_if<Call<Result>>(&source_)) return call->ready();
  if (auto* stream = std::get_if<Stream<Result>>(&source_)) {
    while (!ended_ && stream->ready()) take_next(*stream);
    return ended_;
  }
  return true;
}

template <class Result>
void Awaited<Result>::notify(std::function<void()> action) {
  if (auto* stream = std::get_if<Stream<Result>>(&source_)) {
    stream->notify(std::move(action));
  } else if (auto* call = std::get_if<Call<Result>>(&source_); call && !watched_) {
    watched_ = true;
    call->notify(std::move(action));
  }
}

template <class Result>
bool Awaited<Result>::take_next(Stream<Result>& stream) {
  try {
    auto next = stream.next();
    ended_ = !next;
    if (next) last_ = std::move(next);
  } catch (const TimedOut&) {
    ended_ = true;
    if (!last_) error_ = std::current_exception();
  } catch (...) {
    ended_ = true;
    error_ = std::current_exception();
  }
  return !ended_;
}

template <class Result>
Result Awaited<Result>::get() {
  if (auto* call = std::get_if<Call<Result>>(&source_)) return call->get();
  if (auto* stream = std::get_if<Stream<Result>>(&source_)) {
    while (!ended_ && take_next(*stream)) {
    }
    if (error_) std::rethrow_exception(error_);
    if (!last_) throw Internal("the stream ended without a result");
    return std::move(*last_);
  }
  return std::move(std::get<Result>(source_));
}

}  // namespace skein
