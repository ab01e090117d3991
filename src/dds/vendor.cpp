#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>

#include "skein/core/error.hpp"
#include "skein/core/suggestion.hpp"
#include "skein/dds/loopback.hpp"
#include "skein/dds/module.hpp"

extern "C" std::uint32_t skein_abi() { return SKEIN_ABI; }

namespace skein::dds {
namespace {

struct Module {
  std::string vendor;
  std::string package;  // holds the vendor's own library
};

const std::vector<Module>& modules() {
  static const std::vector<Module> known{{"fastdds", "libfastrtps2.9"},
                                         {"cyclonedds", "libddsc0debian"}};
  return known;
}

std::shared_ptr<Vendor> process_wide_loopback() {
  // Never destroyed: participants in other static objects may outlive this one.
  static auto* clock = new SystemClock;
  static auto* network = new LoopbackNetwork(*clock);
  return network->vendor();
}

/// The directories to look in, most particular first.
std::vector<std::filesystem::path> directories() {
  std::vector<std::filesystem::path> places;
  if (const char* listed = std::getenv("SKEIN_MODULE_PATH")) {
    const std::string text(listed);
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(':', begin), text.size());
      if (end > begin) places.emplace_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  Dl_info own{};
  if (dladdr(reinterpret_cast<void*>(&skein_abi), &own) != 0 && own.dli_fname != nullptr) {
    const auto directory = std::filesystem::absolute(own.dli_fname).parent_path();
    places.push_back(directory);
    places.push_back(directory / "skein");
  }
  return places;
}

[[noreturn]] void throw_unloadable(const Module& module, const std::string& file) {
  const char* reason = dlerror();
  throw Unavailable("the module " + file + " for '" + module.vendor +
                    "' cannot be loaded: " + (reason != nullptr ? reason : "no reason given") +
                    "; if the vendor's library is missing, install the package " + module.package);
}

/// Never unloaded: vendors' threads and thread-local destructors run code of the module.
void* open_module(const Module& module) {
  const std::string file = "libskein_" + module.vendor + ".so";
  std::string looked_in;
  for (const auto& directory : directories()) {
    const auto path = directory / file;
    looked_in += directory.string() + ", ";
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) continue;
    if (void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
    throw_unloadable(module, path.string());
  }
  if (void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
  throw Unavailable("no module " + file + " for '" + module.vendor + "' in " + looked_in +
                    "or the loader's directories; set SKEIN_MODULE_PATH, or install Skein's module " +
                    "and the package " + module.package);
}

template <class Function>
Function* symbol(void* handle, const char* name, const Module& module) {
  if (void* found = dlsym(handle, name)) return reinterpret_cast<Function*>(found);
  throw Unavailable("libskein_" + module.vendor + ".so exports no " + name +
                    ": it is no module of Skein, or of another version");
}

std::shared_ptr<Vendor> load_module(const Module& module) {
  void* handle = open_module(module);
  const std::uint32_t abi = symbol<decltype(skein_module_abi)>(handle, "skein_module_abi", module)();
  if (abi != SKEIN_ABI) {
    throw Unavailable("libskein_" + module.vendor + ".so was built for Skein's ABI " +
                      std::to_string(abi) + ", this is ABI " + std::to_string(SKEIN_ABI) +
                      "; install modules and library of one version");
  }
  return *symbol<decltype(skein_module_vendor)>(handle, "skein_module_vendor", module)();
}

}  // namespace

std::shared_ptr<Vendor> load_vendor(const std::string& name) {
  if (name == "loopback") return process_wide_loopback();
  const auto module = std::ranges::find(modules(), name, &Module::vendor);
  if (module == modules().end()) {
    const std::vector<std::string> known{"fastdds", "cyclonedds", "loopback"};
    throw InvalidArgument("there is no DDS vendor '" + name + "'" + suggestion(name, known) +
                          "; known are fastdds, cyclonedds and loopback");
  }
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<Vendor>> loaded;
  std::lock_guard lock(mutex);
  std::shared_ptr<Vendor>& vendor = loaded[name];
  if (!vendor) vendor = load_module(*module);
  return vendor;
}

}  // namespace skein::dds
