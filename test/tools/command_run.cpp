#include "command_run.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "places.hpp"

namespace skein::test {

CommandRun::CommandRun(const std::vector<std::string>& arguments, const CommandOptions& options) {
  std::vector<std::string> words{built_program("skein")};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string file = (folder() / "output").string();
  const std::string taker = options.output.empty() ? file : options.output;
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("no process for a command");
  if (pid_ > 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (options.network >= 0 && setns(options.network, CLONE_NEWNET) != 0) _exit(126);
  if (chdir(folder().c_str()) != 0) _exit(126);
  setenv("XDG_STATE_HOME", folder().c_str(), 1);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(open(taker.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600), STDOUT_FILENO);
  dup2(open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600), STDERR_FILENO);
  if (options.prepare) options.prepare();
  execv(argv[0], argv.data());
  _exit(127);
}

CommandRun::~CommandRun() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

std::string CommandRun::output() const {
  std::ostringstream text;
  text << std::ifstream(folder() / "output").rdbuf();
  return text.str();
}

bool CommandRun::writes(const std::string& part, std::chrono::seconds limit) const {
  const bool written = eventually([&] { return output().find(part) != std::string::npos; }, limit);
  if (!written) std::fprintf(stderr, "instead of '%s':\n%s\n", part.c_str(), output().c_str());
  return written;
}

void CommandRun::signal(int number) const {
  if (pid_ > 0) kill(pid_, number);
}

int CommandRun::wait(std::chrono::seconds limit) {
  eventually(
      [&] {
        int status = 0;
        if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
          pid_ = -1;
          exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        }
        return pid_ < 0;
      },
      limit);
  return exit_code_;
}

std::vector<std::string> commands_with(const std::string& option) {
  std::vector<std::string> found;
  CommandRun all({"complete", "--", ""});
  all.wait();
  std::istringstream lines(all.output());
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(0, line.find('\t'));
    CommandRun help({name, "--help"});
    help.wait();
    const std::string text = help.output();
    if (text.find("Usage: skein " + name + " [OPTIONS]\n") != std::string::npos &&
        text.find("\n  " + option + " ") != std::string::npos)
      found.push_back(name);
  }
  if (found.empty()) throw std::logic_error("no command's help names " + option);
  return found;
}

}  // namespace skein::test
