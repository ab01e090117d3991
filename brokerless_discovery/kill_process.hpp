#pragma once

#include <string>

namespace skein::brokerless_discovery {

/// Kills the process of this host that can be watched at `address` (ServiceDescription::process),
/// running or stopped; SIGKILL, for one that hangs. Never another process, whatever has become of
/// process numbers since, nor one of another user: the kernel says whose address it is. False if
/// no other process of this user has it any more, or this one may not.
bool kill_process(const std::string& address);

/// The same, only where that process is stopped, as by SIGSTOP; one that a debugger holds is not.
bool kill_stopped_process(const std::string& address);

}  // namespace skein::brokerless_discovery
