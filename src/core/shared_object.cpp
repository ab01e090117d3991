#include "core/shared_object.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include "skein/detail/abi.hpp"
#include "skein/error.hpp"

extern "C" std::uint32_t skein_abi() { return SKEIN_ABI; }

namespace skein {
namespace {

using Path = std::filesystem::path;

std::vector<Path> module_directories() {
  std::vector<Path> places;
  if (const char* listed = std::getenv("SKEIN_MODULE_PATH")) {
    std::istringstream text(listed);
    for (std::string place; std::getline(text, place, ':');) {
      if (!place.empty()) places.emplace_back(place);
    }
  }
  Dl_info own{};
  if (dladdr(reinterpret_cast<void*>(&skein_abi), &own) != 0 && own.dli_fname) {
    const Path directory = std::filesystem::absolute(own.dli_fname).parent_path();
    places.push_back(directory);
    places.push_back(directory / "skein");
  }
  return places;
}

}  // namespace

SharedObject::SharedObject(const std::string& name, const std::string& remedy) : file_(name) {
  std::string looked_in;
  if (name.find('/') == std::string::npos) {
    file_ = "lib" + name + ".so";
    for (const Path& directory : module_directories()) {
      looked_in += directory.string() + ", ";
      std::error_code ignored;
      if (!std::filesystem::exists(directory / file_, ignored)) continue;
      file_ = (directory / file_).string();
      break;
    }
  }
  handle_ = dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle_) return;
  const char* reason = dlerror();
  const bool found = file_.find('/') != std::string::npos;
  throw Unavailable(found ? file_ + " cannot be loaded: " + (reason ? reason : "no reason given") +
                                "; " + remedy
                          : "no " + file_ + " in " + looked_in + "nor where the loader looks; " +
                                remedy + ", or name its directory in SKEIN_MODULE_PATH");
}

void* SharedObject::find(const char* symbol) const {
  if (void* found = dlsym(handle_, symbol)) return found;
  throw InvalidArgument(file_ + " exports no " + symbol +
                        ": it was not made for Skein, or for another version");
}

void SharedObject::check_abi(const char* symbol) const {
  const std::uint32_t abi = function<std::uint32_t()>(symbol)();
  if (abi == SKEIN_ABI) return;
  throw InvalidArgument(file_ + " was built for Skein's ABI " + std::to_string(abi) +
                        ", this is ABI " + std::to_string(SKEIN_ABI) +
                        "; build both from one version");
}

}  // namespace skein
