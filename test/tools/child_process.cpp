#include "child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace skein::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kRemembered = 4096;  // what a child has said is for error messages

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> list;
  for (std::string& text : strings) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

void make_pipe(int (&ends)[2]) {
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe for a child process");
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program, const Options& options) : program_(program) {
  const auto own = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<std::string> arguments{(own.parent_path() / program).string()};
  arguments.insert(arguments.end(), options.arguments.begin(), options.arguments.end());
  std::vector<std::string> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) environment.emplace_back(*entry);
  environment.insert(environment.end(), options.environment.begin(), options.environment.end());
  const auto argument_list = pointers(arguments);
  const auto environment_list = pointers(environment);

  std::signal(SIGPIPE, SIG_IGN);  // a child that has been killed does not read
  int to_child[2];
  int from_child[2];
  make_pipe(to_child);
  make_pipe(from_child);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(125);
    if (options.network >= 0 && setns(options.network, CLONE_NEWNET) != 0) _exit(126);
    dup2(to_child[0], STDIN_FILENO);
    dup2(from_child[1], STDOUT_FILENO);
    std::signal(SIGPIPE, SIG_DFL);  // a new program would keep that it is ignored
    if (!options.directory.empty() && chdir(options.directory.c_str()) != 0) _exit(126);
    close_range(STDERR_FILENO + 1, ~0u, 0);  // the vendors' sockets, with their ports
    execve(argument_list[0], argument_list.data(), environment_list.data());
    _exit(127);
  }
  close(to_child[0]);
  close(from_child[1]);
  in_ = to_child[1];
  out_ = from_child[0];
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : program_(std::move(other.program_)),
      pid_(std::exchange(other.pid_, -1)),
      in_(std::exchange(other.in_, -1)),
      out_(std::exchange(other.out_, -1)),
      unread_(std::move(other.unread_)),
      heard_(std::move(other.heard_)) {}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) {
    signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  for (const int end : {in_, out_}) {
    if (end >= 0) close(end);
  }
}

void ChildProcess::send(const std::string& line) {
  const std::string text = line + "\n";
  if (write(in_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw std::runtime_error(program_ + " does not take '" + line + "'; it said:\n" + heard_);
  }
}

std::string ChildProcess::read(Clock::duration patience) {
  const auto end = Clock::now() + patience;
  while (true) {
    if (const auto at = unread_.find('\n'); at != std::string::npos) {
      std::string line = unread_.substr(0, at);
      unread_.erase(0, at + 1);
      heard_ += line + "\n";
      if (heard_.size() > kRemembered) heard_.erase(0, heard_.size() - kRemembered);
      return line;
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd waited{out_, POLLIN, 0};
    if (left <= 0 || poll(&waited, 1, static_cast<int>(left)) <= 0) {
      throw std::runtime_error(program_ + " says nothing more; it said:\n" + heard_);
    }
    char buffer[64 * 1024];
    const ssize_t count = ::read(out_, buffer, sizeof buffer);
    if (count <= 0) throw std::runtime_error(program_ + " has ended; it said:\n" + heard_);
    unread_.append(buffer, static_cast<std::size_t>(count));
  }
}

std::string ChildProcess::expect(const std::string& first, Clock::duration patience) {
  const std::string line = read(patience);
  if (line == first) return "";
  if (line.starts_with(first + " ")) return line.substr(first.size() + 1);
  throw std::runtime_error(program_ + " says '" + line + "' where '" + first + "' was expected");
}

void ChildProcess::signal(int number) {
  if (pid_ <= 0) return;
  kill(pid_, number);
  siginfo_t stopped;  // valgrind does not know that it may be left out
  if (number == SIGSTOP) waitid(P_PID, static_cast<id_t>(pid_), &stopped, WSTOPPED | WNOWAIT);
}

std::string ChildProcess::read_all() {
  std::string text = std::exchange(unread_, "");
  char buffer[4096];
  for (ssize_t count; (count = ::read(out_, buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(count));
  return text;
}

int ChildProcess::finish() {
  end_input();
  int status = 0;
  if (pid_ > 0) waitpid(std::exchange(pid_, -1), &status, 0);  // -1 would be any child
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool ChildProcess::leaves(Clock::duration patience) {
  end_input();
  return eventually(
      [&] {
        if (pid_ > 0 && waitpid(pid_, nullptr, WNOHANG) == pid_) pid_ = -1;
        return pid_ < 0;
      },
      patience);
}

void ChildProcess::end_input() {
  if (in_ >= 0) close(std::exchange(in_, -1));
}

}  // namespace skein::test
