#pragma once

#include <exception>
#include <memory>
#include <mutex>
#include <string>

#include "handles.hpp"
#include "skein/detail/bytes.hpp"

namespace skein::c {

/// An error as C sees it.
struct Failure {
  skein_error_kind kind = SKEIN_OK;
  std::string text{};
  std::string exception{};  ///< The name of one that IDL declares.
  std::string json{};       ///< Its members in one of two encodings.
  std::shared_ptr<const Bytes> cdr{};
};

Failure failure_of(const std::exception_ptr& thrown);
/// What C++ would have thrown. DECLARED becomes Internal: its exception is not known.
std::exception_ptr exception_of(skein_error_kind kind, const std::string& text);

/// Keeps the last failure. Thread-safe.
class ErrorSink {
 public:
  void put(Failure failure);
  /// Never null.
  std::shared_ptr<const Failure> last() const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Failure> last_ = std::make_shared<const Failure>();
};
SKEIN_NAMES(skein_error, Error, ErrorSink);

/// Puts a failure into a sink; nothing happens if there is none.
void report(skein_error sink, const std::exception_ptr& thrown) noexcept;

/// Runs a function of the interface; what it throws goes to `sink`.
template <class Action>
bool attempt(skein_error sink, const Action& action) noexcept {
  try {
    action();
    return true;
  } catch (...) {
    report(sink, std::current_exception());
    return false;
  }
}

/// A sink for one callback: 0 without an error.
class CallbackError {
 public:
  explicit CallbackError(const std::exception_ptr& thrown);
  /// With an empty sink, into which the callback may put an error.
  CallbackError();
  ~CallbackError();
  CallbackError(const CallbackError&) = delete;
  CallbackError& operator=(const CallbackError&) = delete;

  skein_error handle() const noexcept { return handle_; }
  std::shared_ptr<const Failure> last() const { return sink_->last(); }

 private:
  std::shared_ptr<ErrorSink> sink_;
  skein_error handle_{};
};

}  // namespace skein::c
