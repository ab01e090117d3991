#pragma once

// Fast DDS 3, under the names of fast_dds_2.hpp.

#include <fastdds/dds/core/ReturnCode.hpp>
#include <fastdds/dds/core/Time_t.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.hpp>
#include <fastdds/utils/IPLocator.hpp>

#include "raw/message.hpp"

namespace skein::benchmarks::raw {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;
namespace transports = eprosima::fastdds::rtps;

using dds::Duration_t;
inline constexpr auto kOk = dds::RETCODE_OK;

inline constexpr auto kHeartbeatPeriod = &rtps::WriterTimes::heartbeat_period;
inline constexpr auto kNackResponseDelay = &rtps::WriterTimes::nack_response_delay;
inline constexpr auto kNackSuppression = &rtps::WriterTimes::nack_supression_duration;
inline constexpr auto kInitialAckNackDelay = &rtps::ReaderTimes::initial_acknack_delay;
inline constexpr auto kHeartbeatResponseDelay = &rtps::ReaderTimes::heartbeat_response_delay;

class MessageType final : public dds::TopicDataType {
 public:
  MessageType(bool bounded, std::uint32_t greatest) : bounded_(bounded) {
    set_name(kType);
    max_serialized_type_size = bounded ? greatest : 512;
  }
  bool serialize(const void* data, rtps::SerializedPayload_t& payload,
                 dds::DataRepresentationId_t) override {
    const auto& message = *static_cast<const Outgoing*>(data);
    encode(message, reinterpret_cast<char*>(payload.data));
    payload.length = static_cast<std::uint32_t>(encoded_size(message));
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t& payload, void* data) override {
    decode(*static_cast<Message*>(data), reinterpret_cast<char*>(payload.data), payload.length);
    return true;
  }
  std::uint32_t calculate_serialized_size(const void* data, dds::DataRepresentationId_t) override {
    return static_cast<std::uint32_t>(encoded_size(*static_cast<const Outgoing*>(data)));
  }
  void* create_data() override { return new Message; }
  void delete_data(void* data) override { delete static_cast<Message*>(data); }
  bool compute_key(rtps::SerializedPayload_t&, rtps::InstanceHandle_t&, bool) override {
    return false;
  }
  bool compute_key(const void*, rtps::InstanceHandle_t&, bool) override { return false; }
  bool is_bounded() const override { return bounded_; }

 private:
  const bool bounded_;
};

}  // namespace skein::benchmarks::raw
