#pragma once

namespace skein::dds::fastdds {

/// Sends Fast DDS's errors to skein::log instead of standard output.
void route_log();

}  // namespace skein::dds::fastdds
