#pragma once

#include <mutex>

#include "skein/guid.hpp"

namespace eprosima::fastrtps::rtps {
class RTPSParticipant;
}

namespace skein::dds::fastdds {

// Fast DDS 2.9.1 may lock itself up where its liveliness protocol is at work. Who forgets a writer
// may hold the lock of discovery and wait for the timer thread. The timer thread waits for that
// lock, to assert liveliness, or for the lock of the protocol's reader, whose holder waits for the
// lock of discovery. So the timer thread asserts nothing, and the lock of discovery is taken first.

/// Says, as Fast DDS's timer would, that all of a participant's writers live (RTPS 8.4.13). Not on
/// a thread that Fast DDS calls.
void assert_liveliness(eprosima::fastrtps::rtps::RTPSParticipant& participant);

/// Fast DDS's lock of discovery; it lives as long as the participant receives.
std::recursive_mutex& discovery_mutex(eprosima::fastrtps::rtps::RTPSParticipant& participant);

}  // namespace skein::dds::fastdds
