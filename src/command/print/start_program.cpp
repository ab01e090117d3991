#include "start_program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>
#include <vector>

#include "core/system/file_descriptor.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

std::string content_of(const FileDescriptor& file) {
  std::string text(static_cast<std::size_t>(std::max<off_t>(0, ::lseek(file.get(), 0, SEEK_END))),
                   '\0');
  const ssize_t size = ::pread(file.get(), text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, size)));
  return text;
}

}  // namespace

pid_t start_program(std::span<const std::string> words, const Streams& streams, Session session) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  for (const auto& [from, to] : {std::pair(streams.input, STDIN_FILENO),
                                 {streams.output, STDOUT_FILENO},
                                 {streams.errors, STDERR_FILENO}}) {
    if (from >= 0) {
      posix_spawn_file_actions_adddup2(&actions, from, to);
    } else {
      posix_spawn_file_actions_addopen(&actions, to, "/dev/null", O_RDWR, 0);
    }
  }
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  const int flags = POSIX_SPAWN_SETSIGMASK | (session == Session::Own ? POSIX_SPAWN_SETSID : 0);
  posix_spawnattr_setflags(&attributes, static_cast<short>(flags));
  pid_t process = 0;
  const int failure =
      ::posix_spawnp(&process, arguments.front(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == 0) return process;
  throw Unavailable("`" + words.front() + "` does not start: " + std::strerror(failure));
}

int exit_code_of(int wait_status) {
  return WIFSIGNALED(wait_status) ? 128 + WTERMSIG(wait_status) : WEXITSTATUS(wait_status);
}

ProgramEnd run_program(std::span<const std::string> words, std::chrono::seconds limit,
                       const std::function<bool()>& gives_up) {
  // Files, not pipes: nobody has to read both at once.
  const FileDescriptor output(::memfd_create("output", MFD_CLOEXEC));
  const FileDescriptor errors(::memfd_create("errors", MFD_CLOEXEC));
  if (output.get() < 0 || errors.get() < 0)
    throw Unavailable(std::string("no memory for what a program prints: ") + std::strerror(errno));
  const pid_t process = start_program(words, {-1, output.get(), errors.get()}, Session::Own);
  const auto end = std::chrono::steady_clock::now() + limit;
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(process, &status, WNOHANG)) == 0) {
    const bool too_long = std::chrono::steady_clock::now() > end;
    if (too_long || gives_up()) {
      ::kill(process, SIGKILL);
      ::waitpid(process, &status, 0);
      throw Unavailable("`" + words.front() + "` " +
                        (too_long ? "takes longer than " + std::to_string(limit.count()) + " s"
                                  : std::string("was given up")));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  if (ended < 0)
    throw Unavailable("the end of `" + words.front() + "` is not told: " + std::strerror(errno));
  return {exit_code_of(status), content_of(output), content_of(errors)};
}

}  // namespace skein::command
