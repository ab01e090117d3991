#include "harness/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <thread>
#include <utility>

#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

constexpr std::chrono::milliseconds kEndPatience{3000};

struct Pipe {
  int read_end = -1;
  int write_end = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Internal("no pipe to a child: out of file descriptors");
    read_end = ends[0];
    write_end = ends[1];
  }
};

[[noreturn]] void become(std::vector<std::string>& command, int input, int output, int network) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  signal(SIGPIPE, SIG_DFL);  // which outlives the change of program
  if (network >= 0 && setns(network, CLONE_NEWNET) != 0) _exit(126);
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  std::vector<char*> arguments;
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

std::string joined(const std::vector<std::string>& command) {
  std::string text;
  for (const std::string& part : command) text += (text.empty() ? "" : " ") + part;
  return text;
}

}  // namespace

Child::Child(std::vector<std::string> command, int network) : command_(std::move(command)) {
  if (!std::filesystem::exists(command_[0])) {
    throw Skipped(std::filesystem::path(command_[0]).filename().string() +
                  " was not built: its vendor is not installed");
  }
  const Pipe input, output;
  started_ = std::chrono::steady_clock::now();
  pid_ = fork();
  if (pid_ == 0) become(command_, input.read_end, output.write_end, network);
  close(input.read_end);
  close(output.write_end);
  input_ = input.write_end;
  output_ = output.read_end;
  if (pid_ < 0) throw Internal("the process '" + joined(command_) + "' cannot be made");
}

Child::Child(Child&& other) noexcept
    : command_(std::move(other.command_)),
      started_(other.started_),
      pid_(std::exchange(other.pid_, -1)),
      input_(std::exchange(other.input_, -1)),
      output_(std::exchange(other.output_, -1)),
      received_(std::move(other.received_)) {}

Child::~Child() {
  if (input_ >= 0) close(input_);
  const auto end = std::chrono::steady_clock::now() + kEndPatience;
  while (pid_ > 0 && std::chrono::steady_clock::now() < end) {
    if (waitpid(pid_, nullptr, WNOHANG) != 0) pid_ = -1;
    if (pid_ > 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  if (pid_ > 0) kill();
  if (output_ >= 0) close(output_);
}

void Child::send(const std::string& line) {
  const std::string text = line + "\n";
  if (write(input_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw Internal("'" + joined(command_) + "' no longer reads its commands");
  }
}

std::string Child::receive(std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  std::size_t line_end;
  while ((line_end = received_.find('\n')) == std::string::npos) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    pollfd ready{output_, POLLIN, 0};
    if (left.count() <= 0 || poll(&ready, 1, static_cast<int>(left.count())) == 0) {
      throw Internal("'" + joined(command_) + "' said nothing within " +
                     std::to_string(patience.count()) + " ms");
    }
    char buffer[64 * 1024];
    const ssize_t count = read(output_, buffer, sizeof buffer);
    if (count <= 0) throw Internal("'" + joined(command_) + "' has ended; its messages are above");
    received_.append(buffer, static_cast<std::size_t>(count));
  }
  std::string line = received_.substr(0, line_end);
  received_.erase(0, line_end + 1);
  if (line.starts_with("skipped ")) throw Skipped(line.substr(8));
  if (line.starts_with("failed ")) throw Internal("'" + joined(command_) + "': " + line.substr(7));
  return line;
}

Instant Child::kill() {
  const Instant before = std::chrono::steady_clock::now();
  if (pid_ > 0) {  // no other: -1 would be everybody
    ::kill(pid_, SIGKILL);
    reap();
  }
  return before;
}

Instant Child::signal(int number) {
  const Instant before = std::chrono::steady_clock::now();
  if (pid_ > 0) ::kill(pid_, number);
  if (pid_ > 0 && number == SIGSTOP) waitpid(pid_, nullptr, WUNTRACED);
  return before;
}

void Child::reap() noexcept {
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

}  // namespace skein::benchmarks
