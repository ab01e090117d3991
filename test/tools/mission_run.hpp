#pragma once

#include <sstream>

#include "command_run.hpp"

namespace skein::test {

/// A whole mission, flown by `skein launch` in a folder of its own that goes with this object.
class MissionRun {
 public:
  /// Runs the mission to its end; `arguments` follow the profile. A run that lasts longer than five
  /// minutes shows as exit code -1.
  explicit MissionRun(const std::filesystem::path& profile,
                      const std::vector<std::string>& arguments = {})
      : run_(words(profile, arguments)), exit_code_(run_.wait(std::chrono::minutes(5))) {
    std::istringstream written(run_.output());
    for (std::string word; written >> word;) output_ += (output_.empty() ? "" : " ") + word;
  }

  int exit_code() const noexcept { return exit_code_; }
  /// All that the launcher and its processes wrote, with every run of white space as one blank.
  const std::string& output() const noexcept { return output_; }
  std::filesystem::path file(const std::string& name) const { return run_.folder() / name; }

 private:
  static std::vector<std::string> words(const std::filesystem::path& profile,
                                        const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"launch", profile};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }

  CommandRun run_;
  int exit_code_;
  std::string output_;
};

}  // namespace skein::test
