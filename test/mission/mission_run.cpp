#include "mission_run.hpp"

#include <sstream>

#include "../tools/places.hpp"
#include "../tools/shell.hpp"

namespace skein::test {
namespace {

std::string quoted(const std::string& text) { return "'" + text + "'"; }

std::string with_single_blanks(const std::string& text) {
  std::istringstream words(text);
  std::string result;
  for (std::string word; words >> word;) result += (result.empty() ? "" : " ") + word;
  return result;
}

}  // namespace

MissionRun::MissionRun(const std::filesystem::path& profile,
                       const std::vector<std::string>& arguments) {
  const std::string folder = quoted(folder_.path());
  std::string command = "cd " + folder + " && XDG_STATE_HOME=" + folder + " exec timeout 300 " +
                        quoted(built_program("skein")) + " launch " + quoted(profile);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  const auto [exit_code, output] = shell(command);
  exit_code_ = exit_code;
  output_ = with_single_blanks(output);
}

}  // namespace skein::test
