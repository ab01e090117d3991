#include "browser.hpp"

#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

namespace skein::command::designer {
namespace {

/// `sh` ends at once, so that nobody has to wait for what it starts.
void open(const std::string& file) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  std::array<std::string, 5> words{"sh", "-c", R"(xdg-open "$1" >/dev/null 2>&1 &)", "sh", file};
  std::array<char*, 6> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
  pid_t process = 0;
  if (::posix_spawnp(&process, "sh", &actions, &attributes, arguments.data(), environ) == 0)
    ::waitpid(process, nullptr, 0);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
}

}  // namespace

Browser::Browser(const std::string& url) {
  if (!::getenv("DISPLAY") && !::getenv("WAYLAND_DISPLAY")) return;
  const char* const runtime = ::getenv("XDG_RUNTIME_DIR");
  std::string folder = std::string(runtime ? runtime : "/tmp") + "/skein-designer-XXXXXX";
  if (!::mkdtemp(folder.data())) return;  // which only its user may enter
  folder_ = folder;
  const std::string file = folder + "/page.html";
  std::ofstream(file)
      << "<!doctype html><title>Skein</title><meta http-equiv=\"refresh\" content=\"0; url=" << url
      << "\">\n";
  open(file);
}

Browser::~Browser() {
  std::error_code failure;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, failure);
}

}  // namespace skein::command::designer
