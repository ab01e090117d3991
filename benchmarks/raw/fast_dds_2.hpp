#pragma once

// Fast DDS 2, as its raw peers name it. fast_dds_3.hpp has the same names for release 3; CMake
// chooses.

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include "raw/message.hpp"

namespace skein::benchmarks::raw {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
namespace transports = eprosima::fastdds::rtps;

using eprosima::fastrtps::Duration_t;
inline constexpr auto kOk = eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK;

inline constexpr auto kHeartbeatPeriod = &rtps::WriterTimes::heartbeatPeriod;
inline constexpr auto kNackResponseDelay = &rtps::WriterTimes::nackResponseDelay;
inline constexpr auto kNackSuppression = &rtps::WriterTimes::nackSupressionDuration;
inline constexpr auto kInitialAckNackDelay = &rtps::ReaderTimes::initialAcknackDelay;
inline constexpr auto kHeartbeatResponseDelay = &rtps::ReaderTimes::heartbeatResponseDelay;

class MessageType final : public dds::TopicDataType {
 public:
  /// Of at most `greatest` octets, if it is bounded.
  MessageType(bool bounded, std::uint32_t greatest) : bounded_(bounded) {
    setName(kType);
    m_typeSize = bounded ? greatest : 512;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& message = *static_cast<const Outgoing*>(data);
    encode(message, reinterpret_cast<char*>(payload->data));
    payload->length = static_cast<std::uint32_t>(encoded_size(message));
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    decode(*static_cast<Message*>(data), reinterpret_cast<char*>(payload->data), payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return
        [data] { return static_cast<std::uint32_t>(encoded_size(*static_cast<Outgoing*>(data))); };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
  bool is_bounded() const override { return bounded_; }

 private:
  const bool bounded_;
};

}  // namespace skein::benchmarks::raw
