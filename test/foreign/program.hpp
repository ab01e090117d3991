#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

extern char** environ;

namespace skein::test {

/// A program that runs beside the test: its standard input is open until end_input(), its output is
/// kept. Whatever happens, it is gone with the object.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments) {
    int input[2];
    int output[2];
    if (pipe2(input, O_CLOEXEC) != 0 || pipe2(output, O_CLOEXEC) != 0)
      throw std::runtime_error("no pipe");
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output[1], STDOUT_FILENO);
    const int failed = posix_spawn(&process_, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(input[0]);
    close(output[1]);
    input_ = input[1];
    output_ = output[0];
    if (failed != 0) throw std::runtime_error("cannot start " + arguments[0]);
  }
  Program(Program&& other) noexcept
      : process_(std::exchange(other.process_, 0)),
        input_(std::exchange(other.input_, -1)),
        output_(std::exchange(other.output_, -1)) {}
  ~Program() {
    end_input();
    if (output_ >= 0) close(output_);
    if (process_ == 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }

  void end_input() {
    if (input_ >= 0) close(std::exchange(input_, -1));
  }

  /// Everything that it prints, until it ends.
  std::string read_all() {
    std::string text;
    char part[4096];
    for (ssize_t count; (count = read(output_, part, sizeof part)) > 0;) text.append(part, count);
    return text;
  }

  /// Waits for its end; the exit code, or 128 and the signal.
  int wait() {
    int status = 0;
    waitpid(std::exchange(process_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t process_ = 0;
  int input_ = -1;
  int output_ = -1;
};

}  // namespace skein::test
