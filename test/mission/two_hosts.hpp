#pragma once

#include <unistd.h>

#include <string>

#include "../tools/network_space.hpp"

namespace skein::test {

/// Two network namespaces, joined by a pair of veth devices `skein0`: 10.78.0.1 on `alpha`,
/// 10.78.0.2 on `beta`.
struct TwoHosts {
  TwoHosts() {
    const std::string there = "/proc/" + std::to_string(getpid()) + "/fd/";
    alpha.run("ip link add skein0 type veth peer name skein0 netns " + there +
              std::to_string(beta.descriptor()));
    alpha.run("ip addr add 10.78.0.1/24 dev skein0 && ip link set skein0 up");
    beta.run("ip addr add 10.78.0.2/24 dev skein0 && ip link set skein0 up");
    // The kernel sees the carrier a little later; Fast DDS does not speak on a device without.
    for (const NetworkSpace* host : {&alpha, &beta})
      host->run("timeout 20 sh -c 'until ip link show skein0 | grep -q LOWER_UP; do :; done'");
  }

  NetworkSpace alpha;
  NetworkSpace beta;
};

}  // namespace skein::test
