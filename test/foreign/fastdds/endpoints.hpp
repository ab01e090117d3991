#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <string>

/// One side of a service as DDS sees it: a writer and a reader in the default partition, on
/// loopback alone.
class Endpoints {
 public:
  /// Throws std::runtime_error where DDS refuses.
  Endpoints(eprosima::fastdds::dds::TypeSupport written_type, const std::string& written_topic,
            eprosima::fastdds::dds::TypeSupport read_type, const std::string& read_topic);
  ~Endpoints();
  Endpoints(const Endpoints&) = delete;
  Endpoints& operator=(const Endpoints&) = delete;

  /// Throws std::runtime_error where the sample cannot be written.
  void write(void* sample);

  /// Takes the next sample into `sample`, waiting up to `patience_ms`; false where none came.
  bool take(void* sample, int patience_ms);

  void wait_for_acknowledgments(int patience_ms);

  eprosima::fastrtps::rtps::GUID_t writer_guid() const { return writer_->guid(); }

 private:
  eprosima::fastdds::dds::DomainParticipant* participant_;
  eprosima::fastdds::dds::DataWriter* writer_;
  eprosima::fastdds::dds::DataReader* reader_;
};
