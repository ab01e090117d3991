#pragma once

#include "test/tools/network_space.hpp"

namespace skein::test {

/// Two network namespaces, joined by devices `skein0`: 10.78.0.1 on `alpha`, 10.78.0.2 on `beta`.
struct TwoHosts {
  TwoHosts() { join(alpha, beta, "10.78.0"); }

  NetworkSpace alpha;
  NetworkSpace beta;
};

}  // namespace skein::test
