#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace skein {

/// The functions in which another thread of this process is now, innermost first, each as
/// `name (library+0xoffset)`: `addr2line -e library offset` gives the line. Empty where the thread
/// has ended, takes no signals, or does not answer within 100 ms. Thread-safe.
///
/// The thread is interrupted by a real-time signal, whose handler is set at the first call and
/// stays: of those that nobody handles, the highest. A system call that the kernel does not begin
/// again after a signal (signal(7): poll, epoll_wait, nanosleep and others) returns with EINTR.
std::vector<std::string> stack_of(pid_t thread);

}  // namespace skein
