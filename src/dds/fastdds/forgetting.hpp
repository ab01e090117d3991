#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "dds/rtps/rtps_message.hpp"

/// The parts of RTPS by which Fast DDS is kept from a deadlock when it forgets a participant.
///
/// A writer of Fast DDS 2.9.1 forgets a remote reader with its locators locked
/// (StatefulWriter::matched_reader_remove). If all other readers have acknowledged a sample, the
/// writer tells its listener there, which drops the sample from the history. For one that waits to
/// be sent again this takes the flow controller's mutex; the flow controller's thread holds that
/// mutex while it waits for the locators of a writer whose samples it has just sent. Then both wait
/// for good. The listeners of our own writers drop nothing that waits to be sent again
/// (FastWriter). Those of the two writers that announce endpoints are Fast DDS's own, and drop
/// withdrawals.
///
/// So ahead of the farewell of a participant Fast DDS receives that this participant acknowledges
/// all that the two writers have ever sent. What they drop then, they drop under their own mutex
/// alone, for which the flow controller never waits. What they drop when the farewell comes was
/// never sent, or its request would have to come in between: so nothing of it waits to be sent
/// again. That no request comes in between is DiscoveryInput's part.
namespace skein::dds::fastdds {

/// How far the two writers that announce endpoints have come. Thread-safe.
class SentAnnouncements {
 public:
  /// Notes what a submessage announces; to be called before it is sent.
  void note(const rtps_message::Submessage& submessage);

  /// The message by which a participant acknowledges all that was noted.
  using Acknowledgment = std::array<unsigned char, 20 + 2 * 28>;
  Acknowledgment acknowledged_by(const Guid& participant) const;

 private:
  std::atomic<std::int64_t> last_writer_{0};  // sequence numbers
  std::atomic<std::int64_t> last_reader_{0};
};

/// Calls `visit` with each participant that leaves by an RTPS message which the guard has passed.
void for_each_farewell(unsigned char* message, std::size_t size,
                       const std::function<void(const Guid&)>& visit);

}  // namespace skein::dds::fastdds
