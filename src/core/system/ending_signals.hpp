#pragma once

#include <signal.h>

namespace skein {

/// Whether whoever started this process wants it to ignore the signal, as nohup does with SIGHUP
/// and a script with SIGINT for what it starts by `&`.
inline bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// The signals that ask a program to end in order: SIGTERM, and those of SIGINT and SIGHUP that are
/// not ignored. One that is ignored must not be blocked, or it waits to be taken all the same.
inline sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  for (const int signal : {SIGINT, SIGHUP}) {
    if (!is_ignored(signal)) sigaddset(&signals, signal);
  }
  return signals;
}

}  // namespace skein
