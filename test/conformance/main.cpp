#define CATCH_CONFIG_NO_POSIX_SIGNALS
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include <cstdio>

#include "../tools/dying_test.hpp"
#include "wire.hpp"

namespace {

constexpr int kSkipped = 77;

}  // namespace

int main(int count, char** arguments) {
  using namespace skein::dds;
  try {
    load_vendor(conformance::kPairing.writing);
    load_vendor(conformance::kPairing.reading);
  } catch (const skein::Unavailable& missing) {
    std::printf("skipped: %s\n", missing.what());
    return kSkipped;
  }
  return Catch::Session().run(count, arguments);
}
