#include <algorithm>
#include <map>
#include <mutex>

#include "core/suggestion.hpp"
#include "core/system/shared_object.hpp"
#include "dds/port/module.hpp"
#include "dds/port/vendor_names.hpp"
#include "skein/error.hpp"
#include "skein/loopback.hpp"

namespace skein::dds {
namespace {

struct Module {
  std::string vendor;
  std::string package;  // holds the vendor's own library
  bool shared_memory;
  VendorLibrary library;
};

// All that the library knows of its back ends, beside their modules.
const std::vector<Module>& modules() {
  static const std::vector<Module> known{
      {"fastdds",
       "libfastrtps2.9, or libfastdds3.1 on Debian 13",
       true,
       {"fastdds", {"libfastrtps.so.", "libfastdds.so."}, {"2.9.1", "3.1.2"}}},
      {"cyclonedds",
       "libddsc0debian, or libddsc0t64 on Debian 13",
       false,
       {"cyclonedds", {"libddsc.so."}, {"0.10.2", "0.10.5"}}}};
  return known;
}

template <class Condition>
std::vector<std::string> names_of_modules(Condition condition) {
  std::vector<std::string> names;
  for (const Module& module : modules()) {
    if (condition(module)) names.push_back(module.vendor);
  }
  return names;
}

std::shared_ptr<Vendor> process_wide_loopback() {
  // Never destroyed: participants in other static objects may outlive this one.
  static auto* clock = new SystemClock;
  static auto* network = new LoopbackNetwork(*clock);
  return network->vendor();
}

std::shared_ptr<Vendor> load_module(const Module& module) {
  try {
    const SharedObject object("skein_" + module.vendor,
                              "install Skein's module, package skein-" + module.vendor +
                                  ", and the vendor's library, package " + module.package);
    object.check_abi("skein_module_abi");
    return *object.function<decltype(skein_module_vendor)>("skein_module_vendor")();
  } catch (const InvalidArgument& other_version) {
    throw Unavailable(other_version.what());
  }
}

}  // namespace

const std::vector<std::string>& networked_vendors() {
  static const auto names = names_of_modules([](const Module&) { return true; });
  return names;
}

const std::vector<std::string>& vendor_names() {
  static const auto names = [] {
    auto all = networked_vendors();
    all.push_back(kLoopback);
    return all;
  }();
  return names;
}

const std::vector<std::string>& shared_memory_vendors() {
  static const auto names =
      names_of_modules([](const Module& module) { return module.shared_memory; });
  return names;
}

const std::vector<VendorLibrary>& vendor_libraries() {
  static const auto libraries = [] {
    std::vector<VendorLibrary> all;
    for (const Module& module : modules()) all.push_back(module.library);
    return all;
  }();
  return libraries;
}

std::string alternatives(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 < names.size() ? ", " : " or ";
    text += names[i];
  }
  return text;
}

std::shared_ptr<Vendor> load_vendor(const std::string& name) {
  if (name == kLoopback) return process_wide_loopback();
  const auto module = std::ranges::find(modules(), name, &Module::vendor);
  if (module == modules().end()) {
    throw InvalidArgument("there is no DDS vendor '" + name + "'" +
                          suggestion(name, vendor_names()) + "; write " +
                          alternatives(vendor_names()));
  }
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<Vendor>> loaded;
  std::lock_guard lock(mutex);
  std::shared_ptr<Vendor>& vendor = loaded[name];
  if (!vendor) vendor = load_module(*module);
  return vendor;
}

}  // namespace skein::dds
