#pragma once

#include <cerrno>
#include <string>

#include "skein/error.hpp"

namespace skein {

/// Whether a system call that failed with `error` may succeed later, though nobody changes a name
/// or a file: the machine lacks something for the moment.
inline bool is_passing(int error) noexcept {
  switch (error) {
    case EAGAIN:
    case EBUSY:
    case EDQUOT:
    case EHOSTDOWN:
    case EHOSTUNREACH:
    case EIO:
    case EMFILE:
    case ENETDOWN:
    case ENETUNREACH:
    case ENFILE:
    case ENODEV:
    case ENOMEDIUM:
    case ENOMEM:
    case ENOSPC:
    case ENOTCONN:
    case ENXIO:
    case ESTALE:
    case ETIMEDOUT:
    case ETXTBSY:
      return true;
    default:
      return false;
  }
}

/// For a file that a person has named: Unavailable if `error` is passing, so that whoever restarts
/// this process tries again, InvalidArgument otherwise.
[[noreturn]] inline void throw_for_file(int error, const std::string& text) {
  if (is_passing(error)) throw Unavailable(text);
  throw InvalidArgument(text);
}

}  // namespace skein
