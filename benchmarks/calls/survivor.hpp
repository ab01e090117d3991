#pragma once

#include "calls/skein_peer.hpp"

namespace skein::benchmarks {

/// One of two peers that go through faults; both provide the service, so that each has something to
/// find again, and the one whose role is `client` calls the other. Every one knows `complete`
/// (waits until it knows both providers; answers with the time, in ns), the client also
///
/// | command | answer |
/// |---|---|
/// | `overdue COUNT` | `times`: of calls that nobody answers, from their deadline to their end |
/// | `answered` | calls until it has an answer: `answered` with the time, in ns |
void survive(const SkeinPeer& peer);

}  // namespace skein::benchmarks
