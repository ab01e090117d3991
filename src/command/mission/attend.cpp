#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "command/commands.hpp"
#include "mission/hosts/ssh_attendance.hpp"
#include "mission/supervise/shell_word.hpp"
#include "mission_plan.hpp"
#include "narrator.hpp"

namespace skein::command {
namespace {

/// For the shell on the other host: Skein of the same folder as here, or of its PATH.
std::string remote_command(const AttendArguments& arguments) {
  const auto self = std::filesystem::read_symlink("/proc/self/exe");
  std::string command = "env PATH=" + launch::shell_word(self.parent_path()) + ":\"$PATH\"";
  if (const char* modules = std::getenv("SKEIN_MODULE_PATH"))
    command += " SKEIN_MODULE_PATH=" + launch::shell_word(modules);
  std::vector<std::string> words{self.filename(), "launch",       "--attended",
                                 "--host",        arguments.host, arguments.profile};
  pass_on_choice(words, arguments);
  for (const std::string& word : words) command += " " + launch::shell_word(word);
  return command;
}

}  // namespace

int attend(const AttendArguments& arguments) {
  using launch::AttendedReport;
  const profile::MissionProfile mission = read_mission(arguments);
  Narrator narrator(plan_of(mission, arguments), arguments.verbose);
  launch::SshAttendance attendance;
  attendance.host = arguments.host;
  attendance.command = remote_command(arguments);
  attendance.hello = hello_of(mission);
  attendance.on_report = [&](const AttendedReport& report) {
    if (report.kind == AttendedReport::Kind::Output) narrator.tell_line(report.child, report.text);
    // What is told of the mission as a whole, the launcher here tells itself.
    if (report.kind == AttendedReport::Kind::Event && !report.child.empty())
      narrator.tell({report.child, report.state, report.text});
  };
  attendance.on_text = [&](std::string_view line) {
    narrator.tell_error("* " + std::string(line));
  };
  return launch::attend_over_ssh(attendance);
}

}  // namespace skein::command
