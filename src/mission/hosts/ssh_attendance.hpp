#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "mission/hosts/attended_report.hpp"

namespace skein::launch {

inline constexpr std::chrono::milliseconds kHeartbeat{500};

/// How a launcher on another host is started, and attended from here.
struct SshAttendance {
  std::string host;     ///< As ssh knows it, by the user's own configuration.
  std::string command;  ///< For the shell there: runs a launcher that is attended (run_attended).
  std::string hello;    ///< What it must say first.
  std::function<void(const AttendedReport& report)> on_report;
  /// A line that is no report: of ssh itself, or of the other host's shell.
  std::function<void(std::string_view line)> on_text;
};

/// Runs the command there until it ends, and keeps it alive; ends it in order on SIGINT, SIGTERM
/// and SIGHUP. Tells the launcher that started this process what it waits for, and when the other
/// one's processes are all ready. Returns the other launcher's exit code; kStartFailed or kPeerLost
/// where the connection failed before or after all was ready there; kConfigurationError where the
/// hello is another, with both in on_text().
///
/// The other side ends by itself when it hears nothing any more: see run_attended().
int attend_over_ssh(const SshAttendance& attendance);

/// The words of the command line that attend_over_ssh() runs.
std::vector<std::string> ssh_command(const SshAttendance& attendance);

}  // namespace skein::launch
