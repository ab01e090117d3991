#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <span>
#include <string>

namespace skein::command {

/// Descriptors that become a program's own. -1: /dev/null.
struct Streams {
  int input = -1;
  int output = -1;
  int errors = -1;
};

enum class Session {
  Shared,
  Own,  ///< What ends this process by its terminal does not end the program.
};

/// Starts a program of PATH as a child that has none of this process's other descriptors and
/// blocked signals. Throws Unavailable with the reason if it does not start; the caller waits for
/// its end.
pid_t start_program(std::span<const std::string> words, const Streams& streams,
                    Session session = Session::Shared);

/// How a program has ended, and all that it has printed.
struct ProgramEnd {
  int exit_code = 0;  ///< 128 and the signal, if one has ended it.
  std::string output;
  std::string errors;
};

/// Runs a program to its end, in a session of its own. Throws as start_program(), and Unavailable
/// if it takes longer or `gives_up` returns true, which end it, or if its end cannot be told.
ProgramEnd run_program(std::span<const std::string> words, std::chrono::seconds limit,
                       const std::function<bool()>& gives_up);

/// As the shell has it.
int exit_code_of(int wait_status);

}  // namespace skein::command
