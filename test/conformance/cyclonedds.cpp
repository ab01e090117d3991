#include "wire.hpp"

const skein::dds::conformance::Pairing skein::dds::conformance::kPairing{"cyclonedds",
                                                                         "cyclonedds"};
