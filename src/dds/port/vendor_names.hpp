#pragma once

#include <string>
#include <vector>

// What is known of the vendors without loading one: from the table in vendor.cpp, which alone names
// them.
namespace skein::dds {

/// The network inside of one process, which needs no module.
inline constexpr const char* kLoopback = "loopback";

/// The names that load_vendor() takes, whether or not the vendor is installed: in the order of the
/// table, kLoopback last. The first is a profile's where it names none.
const std::vector<std::string>& vendor_names();

/// Those of them that reach other processes: all but kLoopback.
const std::vector<std::string>& networked_vendors();

/// Those of them that have shared memory (see Network).
const std::vector<std::string>& shared_memory_vendors();

/// A vendor's own library, which its module loads.
struct VendorLibrary {
  std::string vendor;
  std::vector<std::string> files;     ///< How its file's name may begin; the version follows.
  std::vector<std::string> versions;  ///< With which Skein is tested.
};

const std::vector<VendorLibrary>& vendor_libraries();

/// For messages: `a`, `a or b`, `a, b or c`.
std::string alternatives(const std::vector<std::string>& names);

}  // namespace skein::dds
