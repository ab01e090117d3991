// repeater: hears foreign::Sounding and publishes it twice as deep, until it hears of a depth below
// 0. Nothing of Skein: what fastddsgen made of the flattened IDL, and Fast DDS.
#include <cstdio>

#include "endpoints.hpp"
#include "lookout_ddsPubSubTypes.h"

namespace {

constexpr int kPatienceMs = 60000;

}  // namespace

int main() {
  using eprosima::fastdds::dds::TypeSupport;
  try {
    Endpoints topics(TypeSupport(new foreign::SoundingPubSubType), "repeated",
                     TypeSupport(new foreign::SoundingPubSubType), "soundings");
    foreign::Sounding sounding;
    while (topics.take(&sounding, kPatienceMs)) {
      const bool last = sounding.depth_m() < 0;
      sounding.depth_m(2 * sounding.depth_m());
      topics.write(&sounding);
      if (!last) continue;
      topics.wait_for_acknowledgments(kPatienceMs);
      return 0;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 3;
}
