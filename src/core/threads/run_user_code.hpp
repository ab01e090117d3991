#pragma once

#include <exception>
#include <string>

#include "skein/error.hpp"

namespace skein {

/// Calls `code` of a user. What it throws is thrown on with `place` before its text:
/// InvalidArgument as such, all else as Unavailable, also what is no std::exception.
template <class Code>
decltype(auto) run_user_code(const std::string& place, const Code& code) {
  try {
    return code();
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(place + error.what());
  } catch (const std::exception& error) {
    throw Unavailable(place + error.what());
  } catch (...) {
    throw Unavailable(place + "it threw something that is no std::exception");
  }
}

}  // namespace skein
