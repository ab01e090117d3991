#include "harness/loopback_traffic.hpp"

#include <fstream>
#include <sstream>
#include <string>

#include "harness/skipped.hpp"

namespace skein::benchmarks {

LoopbackTraffic loopback_traffic() {
  std::ifstream file("/proc/self/net/dev");
  for (std::string line; std::getline(file, line);) {
    const std::size_t name = line.find("lo:");
    if (name == std::string::npos) continue;
    std::istringstream received(line.substr(name + 3));  // what is sent there is received there
    LoopbackTraffic traffic;
    received >> traffic.octets >> traffic.packets;
    return traffic;
  }
  throw Skipped("/proc/self/net/dev does not tell of loopback");
}

}  // namespace skein::benchmarks
