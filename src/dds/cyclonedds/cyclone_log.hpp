#pragma once

#include <string>

namespace skein::dds::cyclonedds {

/// Sends Cyclone's warnings and errors to skein::log instead of standard error.
void route_log();

/// While it lives, errors that Cyclone reports on this thread are kept for an exception's text
/// instead of being logged.
class ErrorCapture {
 public:
  ErrorCapture();
  ~ErrorCapture();
  std::string text() const;
};

}  // namespace skein::dds::cyclonedds
