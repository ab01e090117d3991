#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "skein/core/call.hpp"
#include "skein/entity/evaluation.hpp"
#include "skein/entity/selection.hpp"
#include "skein/entity/synthesis.hpp"

namespace skein {

/// How many CSPs work on a task at a time.
enum class Execution {
  One,        ///< The next begins when one has failed or had its slice.
  Staggered,  ///< The next begins, too, when the last is late; all go on.
  All,        ///< All begin at once.
};

const char* to_string(Execution execution) noexcept;

/// What a task's `run` returns: the call that it made, the stream whose last result counts (also
/// where the time is up before its end), or, where it has waited itself, the result.
template <class Result>
class Awaited {
 public:
  Awaited(Result result) : source_(std::move(result)) {}
  Awaited(Call<Result> call) : source_(std::move(call)) {}
  Awaited(Stream<Result> stream) : source_(std::move(stream)) {}

  /// Whether get() would return at once.
  bool ready();

  /// Runs `action` when ready() should be asked again, as Call::notify() does. Once for each false
  /// ready().
  void notify(std::function<void()> action);

  /// Waits for the result, or throws what ended the call.
  Result get();

 private:
  bool take_next(Stream<Result>& stream);

  std::variant<Result, Call<Result>, Stream<Result>> source_;
  bool watched_ = false;
  bool ended_ = false;
  std::optional<Result> last_;
  std::exception_ptr error_;
};

/// What of a task does not depend on its types.
struct TaskOptions {
  /// The Body's name for the request, for the record.
  std::string request{};
  /// Only the CSP of that name; empty lets the Head choose.
  std::string only{};
  /// What of the request may matter for the choice.
  Features features{};
  Execution execution = Execution::One;
  /// How many CSPs may work at a time.
  std::size_t width = SIZE_MAX;
  /// How many accepted results are enough to ask for a synthesis; kAll waits for every CSP that was
  /// begun, until the time is up.
  std::size_t enough = 1;
  static constexpr std::size_t kAll = SIZE_MAX;
};

/// A task for whichever CSP the Head selects. Its functions run on the thread that performs it.
template <class Interface, class Result>
struct Task : TaskOptions {
  /// Calls the CSP by its proxy, whose calls end after `budget`. With several CSPs at a time it
  /// must not wait itself, but return what an `async_` twin returned.
  std::function<Awaited<Result>(typename Interface::Proxy& csp, Duration budget)> run{};
  Evaluation<Result> evaluate{};
  /// Whether an exception that the interface declares settles the matter, so that no other CSP
  /// needs to be asked. Empty: none does.
  std::function<bool(const UserException&, const Candidate&)> settles{};
  /// How good an accepted result is, for the history: on the scale of the attribute `quality`, 0 is
  /// worthless.
  std::function<double(const Result&)> quality{};
  /// Makes one result of those that were accepted, once there are enough, and then at each further
  /// one until it gives something. Empty: the best by `quality`, or the first.
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
