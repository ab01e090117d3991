#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "../tools/temporary_folder.hpp"

namespace skein::test {

/// A whole mission, flown by `skein launch` in a folder of its own that goes with this object.
class MissionRun {
 public:
  /// Runs the mission to its end; `arguments` follow the profile. A run that lasts longer than two
  /// minutes is ended, and shows as exit code 124.
  explicit MissionRun(const std::filesystem::path& profile,
                      const std::vector<std::string>& arguments = {});

  int exit_code() const noexcept { return exit_code_; }
  /// All that the launcher and its processes wrote, with every run of white space as one blank.
  const std::string& output() const noexcept { return output_; }
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }

 private:
  TemporaryFolder folder_;
  std::string output_;
  int exit_code_ = -1;
};

}  // namespace skein::test
