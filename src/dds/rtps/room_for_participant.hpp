#pragma once

#include "dds/port/port.hpp"

namespace skein::dds {

/// Throws Unavailable, which names what is lacking and the remedy, where this process could not
/// have as many more threads and descriptors, and as much more memory, as a vendor's participant
/// with these options takes. A vendor that gets too little in the middle of its work ends the
/// process. Others may take what was there, before the vendor does.
void require_room_for_participant(const ParticipantOptions& options);

}  // namespace skein::dds
