#include "child.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace skein::dds::conformance {

Child::Child(const std::string& program, std::vector<std::string> arguments,
             std::vector<std::string> environment, const std::string& directory) {
  const auto path = std::filesystem::read_symlink("/proc/self/exe").parent_path() / program;
  std::string file = path.string();
  std::vector<char*> argument_list{file.data()};
  for (std::string& argument : arguments) argument_list.push_back(argument.data());
  argument_list.push_back(nullptr);
  std::vector<char*> environment_list;
  for (char** entry = environ; *entry != nullptr; ++entry) environment_list.push_back(*entry);
  for (std::string& variable : environment) environment_list.push_back(variable.data());
  environment_list.push_back(nullptr);

  int to_child[2];
  int from_child[2];
  if (pipe2(to_child, O_CLOEXEC) != 0 || pipe2(from_child, O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipes for a child process");
  }
  pid_ = fork();
  if (pid_ == 0) {
    dup2(to_child[0], 0);
    dup2(from_child[1], 1);
    if (chdir(directory.c_str()) != 0) _exit(126);
    execve(file.c_str(), argument_list.data(), environment_list.data());
    _exit(127);
  }
  close(to_child[0]);
  close(from_child[1]);
  in_ = fdopen(to_child[1], "w");
  out_ = fdopen(from_child[0], "r");
}

Child::~Child() {
  if (pid_ > 0) {
    signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (in_ != nullptr) std::fclose(in_);
  std::fclose(out_);
}

void Child::send(const std::string& line) {
  std::fprintf(in_, "%s\n", line.c_str());
  std::fflush(in_);
}

std::string Child::read() {
  std::string line;
  for (int c = std::fgetc(out_); c != EOF && c != '\n'; c = std::fgetc(out_)) {
    line.push_back(static_cast<char>(c));
  }
  return line;
}

void Child::signal(int number) { kill(pid_, number); }

void Child::stop() {
  signal(SIGSTOP);
  waitpid(pid_, nullptr, WUNTRACED);
}

int Child::finish() {
  std::fclose(in_);
  in_ = nullptr;
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace skein::dds::conformance
