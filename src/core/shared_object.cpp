#include "core/shared_object.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
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

/// What every user may write on the way to a file: the file, its folder, or a folder above, where
/// no sticky bit keeps others from replacing what lies in it. Empty if there is nothing.
std::string open_to_all(const Path& file) {
  using std::filesystem::perms;
  std::error_code unknown;
  const Path real = std::filesystem::canonical(file, unknown);
  if (unknown) return {};
  for (Path place = real; place != place.root_path(); place = place.parent_path()) {
    const auto mode = std::filesystem::status(place, unknown).permissions();
    if (unknown || (mode & perms::others_write) == perms::none) continue;
    const bool above = place != real && place != real.parent_path();
    if (above && (mode & perms::sticky_bit) != perms::none) continue;
    return place.string();
  }
  return {};
}

/// What was built in place of a shared object that is not there, or no such object; empty for
/// nothing.
Path static_library(const Path& wanted) {
  std::vector<Path> places;
  if (wanted.has_parent_path()) {
    places.push_back(wanted.parent_path());
  } else {
    places = module_directories();
  }
  for (const Path& place : places) {
    const Path archive = place / wanted.filename().replace_extension(".a");
    std::error_code ignored;
    if (std::filesystem::exists(archive, ignored)) return archive;
  }
  return {};
}

}  // namespace

SharedObject::SharedObject(const std::string& name, const std::string& remedy, Maker maker)
    : file_(name) {
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
  if (maker == Maker::User) {
    const std::string open = open_to_all(file_);
    if (!open.empty()) {
      throw InvalidArgument(file_ + " is not loaded, since every user may write to " + open +
                            "; take that right away (chmod o-w), or move it to another folder");
    }
  }
  handle_ = dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle_) return;
  const char* reason = dlerror();
  const bool found = file_.find('/') != std::string::npos;
  const Path archive = static_library(file_);
  if (maker == Maker::User && !archive.empty()) {
    throw InvalidArgument(archive.string() +
                          " is a static library; make the plugin a module: add_library(NAME "
                          "MODULE ...)");
  }
  if (::access(file_.c_str(), R_OK) != 0 && errno == EACCES) {
    throw Unavailable(file_ + " may not be read; check its rights, and those of its folders");
  }
  throw Unavailable(found ? file_ + " cannot be loaded: " + (reason ? reason : "no reason given") +
                                "; " + remedy
                          : "no " + file_ + " in " + looked_in + "nor where the loader looks; " +
                                remedy + ", or name its directory in SKEIN_MODULE_PATH");
}

void* SharedObject::find(const char* symbol, const std::string& function) const {
  if (void* found = dlsym(handle_, symbol)) return found;
  // Itanium's ABI: a function type is `F`, its result, its parameters, `E`; a result of a basic
  // type is one letter, and a function's name has none.
  const std::string name = symbol;
  const std::string parameters = function.substr(2, function.size() - 3);
  const std::string mangled = "_Z" + std::to_string(name.size()) + name + parameters;
  if (dlsym(handle_, mangled.c_str()) != nullptr) {
    throw InvalidArgument(file_ + " exports " + name +
                          " as C++; write `extern \"C\"` before its definition");
  }
  const std::string line = name.ends_with("_abi")
                               ? "; a plugin needs the line extern \"C\" std::uint32_t " + name +
                                     "() { return SKEIN_ABI; }"
                               : "";
  throw InvalidArgument(file_ + " exports no " + symbol +
                        ": it was not made for Skein, or for another version" + line);
}

void SharedObject::check_abi(const char* symbol) const {
  const std::uint32_t abi = function<std::uint32_t()>(symbol)();
  if (abi == SKEIN_ABI) return;
  throw InvalidArgument(file_ + " was built for Skein's ABI " + std::to_string(abi) +
                        ", this is ABI " + std::to_string(SKEIN_ABI) +
                        "; build both from one version");
}

}  // namespace skein
