#include "browser.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "command/print/start_program.hpp"
#include "core/system/file_descriptor.hpp"
#include "skein/error.hpp"

namespace skein::command::designer {
namespace {

/// `sh` ends at once, so that this process need not wait for the browser.
void open_in_browser(const std::string& file) {
  const std::array<std::string, 5> words{"sh", "-c", R"(xdg-open "$1" &)", "sh", file};
  try {
    ::waitpid(start_program(words, {}), nullptr, 0);
  } catch (const Unavailable& error) {
    std::fprintf(stderr, "skein: %s\n", error.what());
  }
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
  open_in_browser(file);
}

Browser::~Browser() {
  std::error_code failure;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, failure);
}

}  // namespace skein::command::designer
