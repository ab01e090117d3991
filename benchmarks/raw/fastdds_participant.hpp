#pragma once

#include <cstddef>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include "raw/main.hpp"

namespace skein::benchmarks::raw {

namespace dds = eprosima::fastdds::dds;

/// A participant of Fast DDS with the transport of Skein's back end, on loopback alone.
class FastddsParticipant {
 public:
  /// `greatest_number` of participants are looked for.
  FastddsParticipant(std::uint32_t domain, Way way, std::uint32_t greatest_number = 4);

  /// For calls: reliable, everything kept.
  dds::DataWriter* writer(const char* topic);
  dds::DataReader* reader(const char* topic, dds::DataReaderListener* listener = nullptr);

  /// As Skein's back end makes them.
  dds::DataWriter* writer(const char* topic, Delivery delivery);
  dds::DataReader* reader(const char* topic, Delivery delivery,
                          dds::DataReaderListener* listener = nullptr);

 private:
  dds::Topic* topic_of(const char* name);
  dds::DataWriter* make(const char* topic, dds::DataWriterQos qos);
  dds::DataReader* make(const char* topic, const dds::DataReaderQos& qos,
                        dds::DataReaderListener* listener);

  const Way way_;
  dds::DomainParticipant* participant_;
  dds::Publisher* publisher_;
  dds::Subscriber* subscriber_;
};

}  // namespace skein::benchmarks::raw
