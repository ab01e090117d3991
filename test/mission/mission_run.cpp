#include "mission_run.hpp"

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "../tools/places.hpp"

namespace skein::test {
namespace {

std::string quoted(const std::string& text) { return "'" + text + "'"; }

std::filesystem::path make_folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "skein-mission-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("no folder for the mission: " + pattern);
  return pattern;
}

std::string with_single_blanks(const std::string& text) {
  std::istringstream words(text);
  std::string result;
  for (std::string word; words >> word;) result += (result.empty() ? "" : " ") + word;
  return result;
}

}  // namespace

MissionRun::MissionRun(const std::filesystem::path& profile,
                       const std::vector<std::string>& arguments)
    : folder_(make_folder()) {
  std::string command = "cd " + quoted(folder_) + " && XDG_STATE_HOME=" + quoted(folder_) +
                        " exec timeout 300 " + quoted(built_program("skein")) + " launch " +
                        quoted(profile);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  std::FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) throw std::runtime_error("the mission could not be started: " + command);
  std::string output;
  std::array<char, 4096> part;
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe))
    output.append(part.data(), size);
  const int status = pclose(pipe);
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  output_ = with_single_blanks(output);
}

MissionRun::~MissionRun() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

}  // namespace skein::test
