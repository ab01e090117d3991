#include <cstdio>
#include <filesystem>
#include <string>

#include "command/commands.hpp"
#include "core/system/whole_file.hpp"
#include "mission/hosts/start_script.hpp"
#include "mission_plan.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

void make_executable(const std::filesystem::path& file) {
  using std::filesystem::perms;
  std::filesystem::permissions(file, perms::owner_exec | perms::group_exec | perms::others_exec,
                               std::filesystem::perm_options::add);
}

}  // namespace

int write_script(const ScriptArguments& given) {
  ScriptArguments arguments = given;
  arguments.profile = std::filesystem::absolute(given.profile).string();
  const profile::MissionProfile mission = read_mission(arguments);
  const auto plan = plan_of(mission, arguments);
  if (plan.children.empty()) throw InvalidArgument(launch::nobody_here(mission, arguments.host));
  if (!arguments.output.empty()) {
    write_output(
        [&] { write_whole_file("the script", arguments.output, launch::start_script(plan)); });
    make_executable(arguments.output);
  } else {
    std::fputs(launch::start_script(plan).c_str(), stdout);
  }
  return 0;
}

}  // namespace skein::command
