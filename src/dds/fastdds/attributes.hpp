#pragma once

#include <fastdds/rtps/attributes/HistoryAttributes.h>
#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <fastdds/rtps/attributes/ReaderAttributes.h>
#include <fastdds/rtps/attributes/WriterAttributes.h>
#include <fastdds/rtps/builtin/data/ReaderProxyData.h>
#include <fastdds/rtps/builtin/data/WriterProxyData.h>
#include <fastrtps/attributes/TopicAttributes.h>
#include <fastrtps/qos/ReaderQos.h>
#include <fastrtps/qos/WriterQos.h>

#include <memory>

#include "dds/port/endpoints.hpp"
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

eprosima::fastrtps::TopicAttributes topic_attributes(const Topic& topic);
eprosima::fastrtps::WriterQos writer_qos(const Qos& qos);
eprosima::fastrtps::ReaderQos reader_qos(const Qos& qos);

/// What a peer announces; only what decides about a match.
Endpoint to_endpoint(const rtps::WriterProxyData& writer);
Endpoint to_endpoint(const rtps::ReaderProxyData& reader);

/// Nothing where it is infinite.
std::optional<std::chrono::nanoseconds> from_duration(
    const eprosima::fastrtps::Duration_t& duration);

}  // namespace skein::dds::fastdds
