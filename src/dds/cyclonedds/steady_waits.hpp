#pragma once

namespace skein::dds::cyclonedds {

/// Cyclone 0.10 waits until a time on the wall clock, for a length that it knows: where that clock
/// is set back by an hour meanwhile, a wait of milliseconds lasts an hour, and the participant is
/// silent so long. From here on all of Cyclone's waits in this process last by the steady clock.
/// Logs a warning where this Cyclone's library does not allow it. Before the first domain.
void wait_by_steady_clock();

}  // namespace skein::dds::cyclonedds
