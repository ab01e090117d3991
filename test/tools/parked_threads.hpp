#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace skein::test {

/// How many threads of this process were written off and have come back since.
inline std::size_t parked_threads() {
  std::size_t count = 0;
  std::error_code ignored;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", ignored)) {
    std::string name;
    std::getline(std::ifstream(task.path() / "comm"), name);
    count += name == "skein-parked" ? 1 : 0;
  }
  return count;
}

}  // namespace skein::test
