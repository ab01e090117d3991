#include "skein/error.hpp"

namespace skein {

std::string_view to_string(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::Unavailable:
      return "Unavailable";
    case ErrorCode::Overloaded:
      return "Overloaded";
    case ErrorCode::Disconnected:
      return "Disconnected";
    case ErrorCode::TimedOut:
      return "TimedOut";
    case ErrorCode::Cancelled:
      return "Cancelled";
    case ErrorCode::Unimplemented:
      return "Unimplemented";
    case ErrorCode::InvalidArgument:
      return "InvalidArgument";
    case ErrorCode::Internal:
      break;
  }
  return "Internal";
}

bool is_refusal(ErrorCode code) noexcept {
  return code == ErrorCode::Unavailable || code == ErrorCode::Overloaded;
}

void throw_error(ErrorCode code, const std::string& text) {
  switch (code) {
    case ErrorCode::Unavailable:
      throw Unavailable(text);
    case ErrorCode::Overloaded:
      throw Overloaded(text);
    case ErrorCode::Disconnected:
      throw Disconnected(text);
    case ErrorCode::TimedOut:
      throw TimedOut(text);
    case ErrorCode::Cancelled:
      throw Cancelled(text);
    case ErrorCode::Unimplemented:
      throw Unimplemented(text);
    case ErrorCode::InvalidArgument:
      throw InvalidArgument(text);
    case ErrorCode::Internal:
      break;
  }
  throw Internal(text);
}

}  // namespace skein
