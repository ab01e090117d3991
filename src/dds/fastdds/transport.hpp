#pragma once

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include <atomic>
#include <memory>

namespace skein::dds::fastdds {

namespace rtps = eprosima::fastrtps::rtps;

/// Stands before Fast DDS's UDP and cures two delays at start-up, which nothing in its attributes does:
///
/// - Cyclone's first ACKNACK to a new participant has the count 0, which Fast DDS takes for an old one:
///   discovery then waits a second for the next heartbeat. So Cyclone's counts are raised by one, and
///   that first ACKNACK is given the form in which Fast DDS knows it and answers at once.
/// - Fast DDS announces itself before it listens; the answers are lost, and nobody repeats them. So
///   nothing is sent until the participant has been made.
///
/// (The first must be left out with DDS Security, whose signatures cover the counts.)
struct StartupTransportDescriptor : eprosima::fastdds::rtps::ChainingTransportDescriptor {
  explicit StartupTransportDescriptor(
      std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> udp)
      : ChainingTransportDescriptor(std::move(udp)), state(std::make_shared<State>()) {}

  eprosima::fastdds::rtps::TransportInterface* create_transport() const override;

  struct State {
    std::atomic<bool> open{false};      // lets messages out
    std::atomic<std::uint32_t> ports{0};  // on which it listens
  };
  std::shared_ptr<State> state;
};

/// Changes the ACKNACKs of an RTPS message from Cyclone DDS as described above; others are untouched.
/// Exposed for tests.
void repair_first_acknack(unsigned char* message, std::size_t size);

}  // namespace skein::dds::fastdds
