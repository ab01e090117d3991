#include "process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>

#include "failure.hpp"

extern char** environ;

namespace reconnaissance {
namespace {

// Of what it wrote, as much from the end as is looked at.
constexpr std::size_t kLastWords = 2048;
// From the end of its connection to its own.
constexpr int kToEnd_ms = 200;
constexpr std::string_view kDebianFolder = "/usr/games";

bool may_run(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error) && access(file.c_str(), X_OK) == 0;
}

std::filesystem::path make_folder() {
  std::error_code none;
  std::string pattern =
      (std::filesystem::temp_directory_path(none) / "skein-jsbsim-XXXXXX").string();
  if (none || !mkdtemp(pattern.data()))
    throw JsbsimFailure(
        fmt::format("no folder can be made for JSBSim's files ({}); TMPDIR names "
                    "where they are made",
                    none ? none.message() : std::strerror(errno)));
  return pattern;
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream stream(file);
  stream << text << std::flush;
  if (!stream) throw JsbsimFailure("JSBSim's file cannot be written: " + file.string());
}

/// Those of this process; JSBSim tells of nothing but errors.
std::vector<std::string> environment() {
  std::vector<std::string> variables{"JSBSIM_DEBUG=0"};
  for (char** each = environ; *each; ++each) {
    const std::string_view variable = *each;
    if (!variable.starts_with("JSBSIM_DEBUG=")) variables.emplace_back(variable);
  }
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& each : texts) result.push_back(each.data());
  result.push_back(nullptr);
  return result;
}

}  // namespace

std::optional<std::filesystem::path> find_program(const std::string& name) {
  if (name.find('/') != std::string::npos)
    return may_run(name) ? std::optional(std::filesystem::absolute(name)) : std::nullopt;
  const char* const path = std::getenv("PATH");
  std::string folders = fmt::format("{}:{}", path ? path : "", kDebianFolder);
  for (std::size_t begin = 0; begin < folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    const auto file = std::filesystem::path(folders.substr(begin, end - begin)) / name;
    if (end > begin && may_run(file)) return std::filesystem::absolute(file);
    begin = end + 1;
  }
  return std::nullopt;
}

JsbsimProcess::JsbsimProcess(const std::filesystem::path& program,
                             const std::vector<RootFile>& files, const std::string& script)
    : folder_(make_folder()) {
  try {
    for (const RootFile& each : files) write(folder_ / each.name, each.text);
    output_ = memfd_create("jsbsim-output", MFD_CLOEXEC);
    if (output_ < 0)
      throw JsbsimFailure(fmt::format("no memory for JSBSim's output: {}", std::strerror(errno)));
    start(program, script);
  } catch (...) {
    forget_files();
    if (output_ >= 0) close(output_);
    throw;
  }
}

void JsbsimProcess::start(const std::filesystem::path& program, const std::string& script) {
  std::vector<std::string> arguments{program.string(), "--root=" + folder_.string() + "/",
                                     "--script=" + (folder_ / script).string(), "--suspend",
                                     "--nohighlight"};
  std::vector<std::string> variables = environment();
  const std::vector<char*> argv = pointers(arguments), envp = pointers(variables);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) {  // only what is safe after a fork of one thread among several
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    dup2(nothing, 0);
    dup2(output_, 1);
    dup2(output_, 2);
    close_range(3, ~0U, 0);
    if (chdir(folder_.c_str()) == 0) execve(argv[0], argv.data(), envp.data());
    _exit(127);
  }
  const int error = errno;
  if (nothing >= 0) close(nothing);
  if (pid_ < 0)
    throw JsbsimFailure(
        fmt::format("{} cannot be started: {}", program.string(), std::strerror(error)));
}

JsbsimProcess::~JsbsimProcess() {
  if (runs()) {
    kill(pid_, SIGKILL);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  close(output_);
  forget_files();
}

bool JsbsimProcess::runs() {
  int status = 0;
  if (!status_ && waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
  return !status_;
}

std::string JsbsimProcess::in_words() {
  if (runs()) {
    const int process = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
    pollfd watched{process, POLLIN, 0};
    if (process >= 0) poll(&watched, 1, kToEnd_ms);
    if (process >= 0) close(process);
  }
  std::string words = "it runs";
  if (!runs()) {
    words = WIFSIGNALED(*status_) ? fmt::format("it has died of {}", strsignal(WTERMSIG(*status_)))
                                  : fmt::format("it has ended with {}", WEXITSTATUS(*status_));
  }
  std::array<char, kLastWords> buffer{};
  const off_t size = lseek(output_, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(buffer.size()));
  const ssize_t got = pread(output_, buffer.data(), buffer.size(), from);
  std::string text(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  const auto is_blank = [](char c) { return c == '\n' || c == '\r' || c == ' '; };
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  const std::size_t line = text.find_last_of("\r\n");
  if (line != std::string::npos) text.erase(0, line + 1);
  return text.empty() ? words : fmt::format("{}, and wrote at last: {}", words, text);
}

void JsbsimProcess::forget_files() {
  if (folder_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
  folder_.clear();
}

}  // namespace reconnaissance
