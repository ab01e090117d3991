#pragma once

#include "calls/skein_peer.hpp"

namespace skein::benchmarks {

/// Looks at what is lent to it, until its input ends.
void view(const SkeinPeer& peer);

/// Lends values of 1 MiB and 64 MiB to a peer that runs view(). Knows `lend_one COUNT`,
/// `lend_many COUNT`, and `copy_one COUNT`: so many copies of the same value by memcpy. Their
/// answers are `times`.
void lend(const SkeinPeer& peer);

}  // namespace skein::benchmarks
