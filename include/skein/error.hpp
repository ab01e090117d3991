#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace skein {

/// Classes of failure, by what the caller can do next. The numbers are sent on the wire.
enum class ErrorCode : std::uint32_t {
  Unavailable = 1,      ///< Not executed: no provider is available. Try later or elsewhere.
  Overloaded = 2,       ///< Not executed: a queue is full. Back off, then try again.
  Disconnected = 3,     ///< The provider died or left; whether the call ran is unknown.
  TimedOut = 4,         ///< The deadline passed; whether the call ran is unknown.
  Cancelled = 5,        ///< The caller gave up; whether the call ran is unknown.
  Unimplemented = 6,    ///< The provider does not know the operation or this version of it.
  InvalidArgument = 7,  ///< The input is invalid; the same input will fail again.
  Internal = 8,         ///< The provider failed in a way that its interface does not declare.
};

std::string_view to_string(ErrorCode code) noexcept;

/// Whether the call was not executed, so that another provider may be asked safely: Unavailable and
/// Overloaded.
bool is_refusal(ErrorCode code) noexcept;

/// Base of all errors that Skein itself reports. The text names the cause, the place and, if there
/// is one, the remedy. Exceptions declared in IDL derive from UserException instead.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& text) : std::runtime_error(text), code_(code) {}
  ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

template <ErrorCode kCode>
class ErrorOf : public Error {
 public:
  explicit ErrorOf(const std::string& text) : Error(kCode, text) {}
};

using Unavailable = ErrorOf<ErrorCode::Unavailable>;
using Overloaded = ErrorOf<ErrorCode::Overloaded>;
using Disconnected = ErrorOf<ErrorCode::Disconnected>;
using TimedOut = ErrorOf<ErrorCode::TimedOut>;
using Cancelled = ErrorOf<ErrorCode::Cancelled>;
using Unimplemented = ErrorOf<ErrorCode::Unimplemented>;
using InvalidArgument = ErrorOf<ErrorCode::InvalidArgument>;
using Internal = ErrorOf<ErrorCode::Internal>;

/// Throws the class for `code`; an unknown code (from a newer peer) becomes Internal.
[[noreturn]] void throw_error(ErrorCode code, const std::string& text);

}  // namespace skein
