#include "core/system/shared_object.hpp"

#include <cxxabi.h>
#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/suggestion.hpp"
#include "skein/detail/abi.hpp"
#include "skein/error.hpp"

extern "C" std::uint32_t skein_abi() { return SKEIN_ABI; }

namespace skein {
namespace {

using Path = std::filesystem::path;

/// Of SKEIN_MODULE_PATH.
std::vector<Path> named_directories() {
  std::vector<Path> places;
  if (const char* listed = std::getenv("SKEIN_MODULE_PATH")) {
    std::istringstream text(listed);
    for (std::string place; std::getline(text, place, ':');) {
      if (!place.empty()) places.emplace_back(place);
    }
  }
  return places;
}

std::vector<Path> module_directories() {
  std::vector<Path> places = named_directories();
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
    Path archive = place / wanted.filename().replace_extension(".a");
    std::error_code ignored;
    if (std::filesystem::exists(archive, ignored)) return archive;
  }
  return {};
}

constexpr std::string_view kPrefix = "lib";
constexpr std::string_view kSuffix = ".so";

/// `lift_components` of `liblift_components.so`; empty for what is called otherwise.
std::string module_name(const std::string& file) {
  if (!file.starts_with(kPrefix) || !file.ends_with(kSuffix) ||
      file.size() <= kPrefix.size() + kSuffix.size())
    return {};
  return file.substr(kPrefix.size(), file.size() - kPrefix.size() - kSuffix.size());
}

/// All that the directories of modules hold.
std::vector<std::string> module_names() {
  std::vector<std::string> names;
  for (const Path& directory : module_directories()) {
    std::error_code end;
    for (std::filesystem::directory_iterator file(directory, end), none; !end && file != none;
         file.increment(end)) {
      const std::string name = module_name(file->path().filename().string());
      if (!name.empty()) names.push_back(name);
    }
  }
  return names;
}

/// What to write in place of a name that was not found.
std::string nearest(const std::string& name) {
  const std::string inner = module_name(name);
  return inner.empty() ? suggestion(name, module_names()) : " (write '" + inner + "')";
}

/// Where modules were looked for.
std::string places_looked_in() {
  std::string text;
  const auto named = named_directories();
  for (const Path& place : module_directories()) {
    std::error_code ignored;
    const bool wrong =
        std::ranges::count(named, place) > 0 && !std::filesystem::is_directory(place, ignored);
    text += place.string() + (wrong ? " (of SKEIN_MODULE_PATH, and no folder), " : ", ");
  }
  return text;
}

/// What a plugin calls and none of the libraries that it links defines; empty where the loader says
/// something else.
std::string undefined_function(std::string_view reason) {
  constexpr std::string_view kSaid = "undefined symbol: ";
  const std::size_t at = reason.find(kSaid);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = reason.substr(at + kSaid.size());
  const std::string symbol(rest.substr(0, rest.find_first_of(", \t)")));
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> readable(
      abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status), std::free);
  return readable ? readable.get() : symbol;
}

}  // namespace

SharedObject::SharedObject(const std::string& name, const std::string& remedy, Maker maker)
    : file_(name) {
  if (name.find('/') == std::string::npos) {
    file_ = "lib" + name + ".so";
    for (const Path& directory : module_directories()) {
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
  const char* said = dlerror();
  const std::string reason = said ? said : "no reason given";
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
  if (!found) {
    throw Unavailable("no " + file_ + nearest(name) + " in " + places_looked_in() +
                      "nor where the loader looks; " + remedy +
                      ", or name its directory in SKEIN_MODULE_PATH");
  }
  const std::string missing = undefined_function(reason);
  if (maker == Maker::User && !missing.empty()) {
    throw Unavailable(file_ + " cannot be loaded: it uses " + missing +
                      ", which is not defined; link it with the library that does, or compile what "
                      "does into it");
  }
  const std::string whole = file_ + std::string(kSuffix);
  if (::access(file_.c_str(), F_OK) != 0 && ::access(whole.c_str(), F_OK) == 0)
    throw Unavailable("there is no " + file_ + "; write " + whole);
  throw Unavailable(file_ + " cannot be loaded: " + reason + "; " + remedy);
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
  const std::string line =
      name.ends_with("_abi") ? "; a plugin needs the line extern \"C\" std::uint32_t " + name +
                                   "() { return SKEIN_ABI; }"
      : name.ends_with("_components")
          ? "; a plugin needs the function extern \"C\" void " + name +
                "(skein::ComponentRegistry& registry) { registry.add_body<...>(...); }"
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
