#include "findings_apart.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <string_view>

#include "mission/process/pipe.hpp"
#include "mission/process/wake_up.hpp"
#include "mission/supervise/child_process.hpp"

namespace skein::launch {
namespace {

using profile::Finding;
using profile::Severity;

constexpr std::chrono::seconds kCheckPatience{30};
constexpr char kEndOfField = '\0';
// In place of another finding's severity:
constexpr std::string_view kEndOfFindings = "end";
constexpr std::string_view kStep = "step";  // what follows is no finding, but what begins

std::string to_fields(std::string_view severity, const Finding& finding) {
  std::string text;
  for (const std::string& field :
       {std::string(severity), finding.where.file, std::to_string(finding.where.line),
        std::to_string(finding.where.column), finding.problem, finding.remedy})
    text.append(field) += kEndOfField;
  return text;
}

std::string to_fields(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) text += to_fields(to_string(finding.severity), finding);
  return text.append(kEndOfFindings) += kEndOfField;
}

/// False where the end is missing; `step` is then what had begun.
bool read_fields(const std::string& text, std::vector<Finding>& findings, Finding& step) {
  std::istringstream stream(text);
  const auto next = [&] {
    std::string field;
    std::getline(stream, field, kEndOfField);
    return field;
  };
  for (std::string severity = next(); stream; severity = next()) {
    if (severity == kEndOfFindings) return true;
    Finding finding;
    finding.severity = severity == "error" || severity == kStep ? Severity::Error
                       : severity == "warning"                  ? Severity::Warning
                                                                : Severity::Note;
    finding.where.file = next();
    finding.where.line = std::atoi(next().c_str());
    finding.where.column = std::atoi(next().c_str());
    finding.problem = next();
    finding.remedy = next();
    if (severity == kStep) {
      step = std::move(finding);
    } else {
      findings.push_back(std::move(finding));
    }
  }
  return false;
}

void write_all(int descriptor, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto size = ::write(descriptor, text.data() + at, text.size() - at);
    if (size < 0 && errno != EINTR) ::_exit(1);
    if (size > 0) at += static_cast<std::size_t>(size);
  }
}

[[noreturn]] void look_and_tell(const Look& look, int teller, const std::string& file,
                                pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  std::string text;
  try {
    text = to_fields(look([&](const Finding& step) { write_all(teller, to_fields(kStep, step)); }));
  } catch (const std::exception& error) {
    text = to_fields({{Severity::Error, {file}, error.what(), ""}});
  }
  write_all(teller, text);
  ::_exit(0);  // no destructor of what was loaded runs
}

/// All that comes until the other side closes the pipe; false where that takes too long.
bool read_to_end(int descriptor, std::string& text) {
  const auto end = std::chrono::steady_clock::now() + kCheckPatience;
  std::array<char, 4096> buffer;
  for (;;) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd watched{descriptor, POLLIN, 0};
    if (left.count() <= 0 || ::poll(&watched, 1, static_cast<int>(left.count())) == 0) return false;
    const auto size = ::read(descriptor, buffer.data(), buffer.size());
    if (size == 0) return true;
    if (size > 0) text.append(buffer.data(), static_cast<std::size_t>(size));
  }
}

}  // namespace

std::vector<Finding> findings_apart(const Look& look, const std::string& file) {
  Pipe pipe = make_pipe();
  const pid_t parent = ::getpid();
  const pid_t id = ::fork();
  if (id < 0) throw_system_error("a process");
  if (id == 0) look_and_tell(look, pipe.write_end.get(), file, parent);
  pipe.write_end.reset();
  std::string text;
  const bool in_time = read_to_end(pipe.read_end.get(), text);
  if (!in_time) ::kill(id, SIGKILL);
  siginfo_t end{};
  while (::waitid(P_PID, static_cast<id_t>(id), &end, WEXITED) < 0 && errno == EINTR) {
  }
  std::vector<Finding> findings;
  Finding step{Severity::Error, {file}, "what was to be checked", ""};
  if (read_fields(text, findings, step) && in_time) return findings;
  const std::string how =
      in_time ? "ends its process " + to_text(ExitStatus{end.si_code != CLD_EXITED, end.si_status})
              : "takes longer than " + std::to_string(kCheckPatience.count()) + " s";
  step.problem += " " + how;
  findings.push_back(std::move(step));
  return findings;
}

}  // namespace skein::launch
