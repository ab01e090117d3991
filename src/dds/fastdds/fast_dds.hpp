#pragma once

#include SKEIN_FAST_DDS  // fast_dds_2.hpp or fast_dds_3.hpp, of the release that CMake has found

// Fast DDS as the sources of this back end use it. What its releases do differently has a source of
// each: fast_dds_2.cpp, fast_dds_3.cpp.
namespace skein::dds::fastdds {

/// Leaves out services of Fast DDS's own that Skein has no use for.
void leave_out_services(rtps::RTPSParticipantAttributes& attributes);

/// Makes an endpoint known to others.
bool make_known(rtps::RTPSParticipant& participant, rtps::RTPSWriter& writer, const Topic& topic,
                const WriterQos& qos);
bool make_known(rtps::RTPSParticipant& participant, rtps::RTPSReader& reader, const Topic& topic,
                const ReaderQos& qos);

/// nullptr: no memory. `history` is the writer's.
rtps::CacheChange_t* new_change(rtps::RTPSWriter& writer, rtps::WriterHistory& history,
                                std::uint32_t size, rtps::ChangeKind_t kind,
                                const rtps::InstanceHandle_t& key = rtps::c_InstanceHandle_Unknown);
void release_change(rtps::RTPSWriter& writer, rtps::WriterHistory& history,
                    rtps::CacheChange_t& change);

/// Of a reliable writer; `liveliness`: also if nothing is unacknowledged.
void send_heartbeat(rtps::RTPSWriter& writer, bool liveliness);

/// The writer that says that its participant's writers live (RTPS 8.4.13), and its history.
std::pair<rtps::RTPSWriter*, rtps::WriterHistory*> liveliness_writer(
    rtps::RTPSParticipant& participant);

/// Keeps what Fast DDS holds in static objects until the process is gone.
void keep_static_objects();

/// Turns off delivery inside of the process.
void turn_off_intraprocess_delivery();

}  // namespace skein::dds::fastdds
