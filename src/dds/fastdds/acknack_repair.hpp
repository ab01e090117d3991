#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <unordered_map>

#include "dds/rtps/rtps_message.hpp"

namespace skein::dds::fastdds {

/// Makes ACKNACKs such as Fast DDS understands.
///
/// A reader whose participant has forgotten the writer's, and has found it again, lacks all samples
/// that it had acknowledged before. Fast DDS 2.9 gives it none of them: of what was acknowledged it
/// sends nothing again, unless an ACKNACK with base 0 says that the reader begins anew. Fast DDS's
/// own readers do not send that one when a heartbeat comes first, and may lose it; Cyclone's never
/// do. (With SEDP's writers, the endpoints of a participant stayed unknown for good to one that had
/// once forgotten it.) So an ACKNACK that acknowledges less than the one before it is given that
/// form: Fast DDS answers it with a heartbeat, and gives what is then asked for.
///
/// The count of Cyclone's first ACKNACK is 0, which Fast DDS takes for an old one: discovery would
/// then wait a second for the next heartbeat. So Cyclone's counts are raised by one, and the first
/// ACKNACK is given the form above, too.
///
/// A reader that begins anew counts anew, and would be ignored until it has counted as far as
/// before: on both vendors that is one ACKNACK for each heartbeat, and no heartbeat comes while all
/// seems acknowledged. So the counts go on where they were. Whether or not its first ACKNACK was
/// lost, a reader that has begun anew is known by this: it lacks the first sample, which it had
/// acknowledged, and has counted less far.
///
/// Who wakes from a stop beyond its lease may still acknowledge from memory, to a Fast DDS that has
/// just found it anew, and forget in the next moment. So a Cyclone participant that has just come
/// back acknowledges nothing; what it truly has it says again at the next heartbeat.
///
/// (To be left out with DDS Security, whose signatures cover the counts.)
class AckNackRepair {
 public:
  /// Changes the ACKNACKs of an RTPS message, which the guard has passed, as described above; its
  /// sender has `just_returned` or not. Thread-safe.
  void repair(unsigned char* message, std::size_t size, bool just_returned);

 private:
  /// The sender's prefix, the reader's and the writer's entity id.
  using Endpoints = std::array<unsigned char, 20>;
  struct Hash {
    std::size_t operator()(const Endpoints& endpoints) const noexcept;
  };
  struct Progress {
    std::uint32_t offset = 0;  // what the reader's counts are raised by
    std::uint32_t said = 0;    // the last count, as the reader said it
    std::uint32_t count = 0;   // and as handed on
    std::int64_t base = 0;     // what is below is acknowledged
  };

  void repair_submessage(const unsigned char* sender, const rtps_message::Submessage& submessage,
                         bool cyclone, bool just_returned);

  std::mutex mutex_;
  std::unordered_map<Endpoints, Progress, Hash> progress_;
};

}  // namespace skein::dds::fastdds
