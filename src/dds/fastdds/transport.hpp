#pragma once

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "signs_of_life.hpp"

namespace skein::dds::fastdds {

namespace rtps = eprosima::fastrtps::rtps;

/// Makes Cyclone's ACKNACKs such as Fast DDS understands. Cyclone's first one has the count 0,
/// which Fast DDS takes for an old one: discovery then waits a second for the next heartbeat. So
/// the counts are raised by one, and the first ACKNACK is given the form that Fast DDS answers at
/// once. A Cyclone participant that had forgotten this one (it was stopped beyond the lease) begins
/// at 0 again, and would be ignored for good: so the counts go on where they were.
///
/// Who wakes from such a stop may still acknowledge from memory, to a Fast DDS that has just found
/// it anew, and forget in the next moment: what was acknowledged Fast DDS never sends again (about
/// one time in thirty; the provider was then not found for good). So one who has just come back
/// acknowledges nothing; what it truly has it says again at the next heartbeat.
///
/// (To be left out with DDS Security, whose signatures cover the counts.)
class AckNackRepair {
 public:
  /// Changes the ACKNACKs of an RTPS message from Cyclone DDS as described above, whose sender has
  /// `just_returned` or not; others are untouched. Thread-safe.
  void repair(unsigned char* message, std::size_t size, bool just_returned);

 private:
  struct Counts {
    std::uint32_t offset = 1;
    std::uint32_t last = 0;  // as handed on
  };
  void repair_submessage(const unsigned char* sender, unsigned char* submessage, std::size_t body,
                         bool just_returned);
  std::uint32_t next_count(const std::string& endpoints, std::uint32_t count, bool first);

  std::mutex mutex_;
  std::unordered_map<std::string, Counts> counts_;  // by sender's prefix, reader and writer
};

/// Silence after a sleep. A participant that was stopped beyond its lease is forgotten by the
/// others, and finds their old messages waiting while it still has to forget them too: Fast DDS,
/// which does both at once, then sometimes keeps half of what it knew (about one time in forty),
/// and never tells the others of its endpoints again. So who wakes neither hears nor speaks until
/// the leases that ran out meanwhile have been dealt with.
class WakeWatch {
 public:
  /// A participant announces itself several times in `lease`; who was quiet for half of it slept.
  explicit WakeWatch(std::chrono::nanoseconds lease) : longest_pause_(lease / 2) {}

  /// Notes that a message comes or goes; whether it may. Thread-safe.
  bool may_pass();

 private:
  const std::chrono::nanoseconds longest_pause_;
  std::atomic<std::chrono::steady_clock::rep> last_{0};
  std::atomic<std::chrono::steady_clock::rep> silent_until_{0};
};

/// A transport before Fast DDS's UDP that repairs what is received, notes who is heard of, keeps
/// silence after a sleep, and sends nothing until the participant has been made: Fast DDS announces
/// itself before it listens, and nobody repeats the answers.
struct StartupTransportDescriptor : eprosima::fastdds::rtps::ChainingTransportDescriptor {
  StartupTransportDescriptor(
      std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> udp,
      std::chrono::nanoseconds lease)
      : ChainingTransportDescriptor(std::move(udp)), state(std::make_shared<State>(lease)) {}

  eprosima::fastdds::rtps::TransportInterface* create_transport() const override;

  struct State {
    explicit State(std::chrono::nanoseconds lease) : watch(lease) {}
    std::atomic<bool> open{false};        // lets messages out
    std::atomic<std::uint32_t> ports{0};  // on which it listens
    SignsOfLife signs;
    WakeWatch watch;
  };
  std::shared_ptr<State> state;
};

}  // namespace skein::dds::fastdds
