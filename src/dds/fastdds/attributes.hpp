#pragma once

#include <memory>

#include "dds/port/endpoints.hpp"
#include "fast_dds.hpp"
#include "transport.hpp"

/// Our options and QoS in Fast DDS's terms; where a value is not its default, the reason stands
/// there.
namespace skein::dds::fastdds {

rtps::RTPSParticipantAttributes participant_attributes(
    const ParticipantOptions& options,
    const std::shared_ptr<StartupTransportDescriptor>& transport);

/// UDP alone, on the network's interfaces alone.
std::shared_ptr<StartupTransportDescriptor> make_transport(const ParticipantOptions& options);

rtps::WriterAttributes writer_attributes(const Topic& topic, const Qos& qos);
rtps::ReaderAttributes reader_attributes(const Topic& topic, const Qos& qos);

/// 0: no limit. A writer whose history is full asks for acknowledgment with its last sample.
rtps::HistoryAttributes history_attributes(std::uint32_t max_samples);

WriterQos writer_qos(const Qos& qos);
ReaderQos reader_qos(const Qos& qos);

/// What a peer announces; only what decides about a match.
Endpoint to_endpoint(Side side, const AnnouncedEndpoint& endpoint);

/// Nothing where it is infinite.
std::optional<std::chrono::nanoseconds> from_duration(const Duration_t& duration);

}  // namespace skein::dds::fastdds
