#include <algorithm>
#include <map>
#include <mutex>

#include "skein/core/error.hpp"
#include "skein/core/shared_object.hpp"
#include "skein/core/suggestion.hpp"
#include "skein/dds/loopback.hpp"
#include "skein/dds/module.hpp"

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

std::shared_ptr<Vendor> load_module(const Module& module) {
  try {
    const SharedObject object("skein_" + module.vendor,
                              "install Skein's module for '" + module.vendor +
                                  "' and the vendor's library, package " + module.package);
    object.check_abi("skein_module_abi");
    return *object.function<decltype(skein_module_vendor)>("skein_module_vendor")();
  } catch (const InvalidArgument& other_version) {
    throw Unavailable(other_version.what());
  }
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
