#include <cstdio>

#include "skein/error.hpp"
#include "test/tools/prepare.hpp"
#include "wire.hpp"

int skein::test::prepare() {
  constexpr int kSkipped = 77;
  try {
    dds::load_vendor(dds::conformance::kPairing.writing);
    dds::load_vendor(dds::conformance::kPairing.reading);
  } catch (const Unavailable& missing) {
    std::printf("skipped: %s\n", missing.what());
    return kSkipped;
  }
  return 0;
}
