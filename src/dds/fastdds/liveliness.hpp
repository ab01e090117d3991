#pragma once

#include "fast_dds.hpp"

namespace skein::dds::fastdds {

// Fast DDS may lock itself up where its liveliness protocol is at work. Who removes an endpoint
// holds the lock of discovery and may wait for the timer thread. The timer thread waits for that
// lock, to assert liveliness, or for the lock of the protocol's reader, whose holder, a receiving
// thread, waits for the lock of discovery. So the timer thread asserts nothing, and no message of
// discovery is received while an endpoint is removed (DiscoveryInput::removal).

/// Says, as Fast DDS's timer would, that all of a participant's writers live (RTPS 8.4.13). Not on
/// a thread that Fast DDS calls.
void assert_liveliness(rtps::RTPSParticipant& participant);

}  // namespace skein::dds::fastdds
