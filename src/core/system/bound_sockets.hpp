#pragma once

#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace skein {

/// The sockets that are bound to names in the abstract namespace: by name, what a process's
/// descriptor of it links to in /proc.
std::map<std::string, std::string> bound_sockets();

/// What the process's descriptors link to; empty also if this process may not know.
std::vector<std::string> open_in(pid_t process);

}  // namespace skein
