#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "skein/guid.hpp"

/// Keeps participants' leases from Fast DDS: puts them off in what it receives, and makes the
/// farewell that it receives when one runs out, as FastLeaseWatch (fast_lease_watch.hpp) judges.
/// Fast DDS's own timer for them runs on a thread of its own, beside the one that receives, and
/// they share the proxy of the participant: where one has left and its timer goes off while the
/// proxy is being cleared, Fast DDS aborts (PDP::check_remote_participant_liveliness asserts that
/// the GUID is known); where a proxy is made while its lease, of some milliseconds, runs out, one
/// works with what the other has given back. So Fast DDS is told of leases that do not run out in
/// anybody's life, and when one does, it receives what the participant itself would have sent had
/// it left: this is handled like any other message.
namespace skein::dds::fastdds {

/// By how much leases are put off: 2^30 s, 34 years.
inline constexpr std::uint32_t kPutOffSeconds = 1u << 30;

/// Adds kPutOffSeconds to the lease of each participant that an RTPS message announces, which the
/// guard has passed.
void put_off_leases(unsigned char* message, std::size_t size);

/// The lease that was announced, of the one that Fast DDS read; nothing where it never runs out.
std::optional<std::chrono::nanoseconds> announced_lease(std::int32_t seconds,
                                                        std::uint32_t nanoseconds);

/// The message by which a participant says that it leaves: a disposal of its announcement.
using Farewell = std::array<unsigned char, 76>;
Farewell make_farewell(const Guid& participant);

}  // namespace skein::dds::fastdds
