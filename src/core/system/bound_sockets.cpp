#include "core/system/bound_sockets.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

namespace skein {
namespace {

constexpr std::string_view kUnconnected = "01";  // SS_UNCONNECTED of <linux/net.h>

}  // namespace

std::map<std::string, std::string> bound_sockets() {
  std::map<std::string, std::string> links;
  std::ifstream sockets("/proc/net/unix");
  for (std::string line; std::getline(sockets, line);) {
    std::istringstream columns(line);
    std::string word, state, inode, shown;
    for (int i = 0; i < 5; ++i) columns >> word;
    columns >> state >> inode >> shown;
    // What is connected to it bears its name, too.
    if (state == kUnconnected && shown.starts_with('@'))
      links.emplace(shown.substr(1), "socket:[" + inode + "]");
  }
  return links;
}

std::vector<std::string> open_in(pid_t process) {
  std::vector<std::string> links;
  std::error_code error;
  std::filesystem::directory_iterator each("/proc/" + std::to_string(process) + "/fd", error);
  for (; !error && each != std::filesystem::directory_iterator(); each.increment(error)) {
    std::error_code closed;
    links.push_back(std::filesystem::read_symlink(each->path(), closed));
  }
  return links;
}

}  // namespace skein
