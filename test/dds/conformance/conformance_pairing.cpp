#include "wire.hpp"

const skein::dds::conformance::Pairing skein::dds::conformance::kPairing{SKEIN_WRITING,
                                                                         SKEIN_READING};
