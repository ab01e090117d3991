#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "skein/detail/version.hpp"

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

/// Base of all errors that Skein itself reports. The text names the cause, and the place and the
/// remedy where there are any. Exceptions declared in IDL derive from UserException instead.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& text) : std::runtime_error(text), code_(code) {}
  ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

class Unavailable : public Error {
 public:
  explicit Unavailable(const std::string& text) : Error(ErrorCode::Unavailable, text) {}
};

class Overloaded : public Error {
 public:
  explicit Overloaded(const std::string& text) : Error(ErrorCode::Overloaded, text) {}
};

class Disconnected : public Error {
 public:
  explicit Disconnected(const std::string& text) : Error(ErrorCode::Disconnected, text) {}
};

class TimedOut : public Error {
 public:
  explicit TimedOut(const std::string& text) : Error(ErrorCode::TimedOut, text) {}
};

class Cancelled : public Error {
 public:
  explicit Cancelled(const std::string& text) : Error(ErrorCode::Cancelled, text) {}
};

class Unimplemented : public Error {
 public:
  explicit Unimplemented(const std::string& text) : Error(ErrorCode::Unimplemented, text) {}
};

class InvalidArgument : public Error {
 public:
  explicit InvalidArgument(const std::string& text) : Error(ErrorCode::InvalidArgument, text) {}
};

class Internal : public Error {
 public:
  explicit Internal(const std::string& text) : Error(ErrorCode::Internal, text) {}
};

/// Throws the class for `code`; an unknown code (from a newer peer) becomes Internal.
[[noreturn]] void throw_error(ErrorCode code, const std::string& text);

}  // namespace skein
