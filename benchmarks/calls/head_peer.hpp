#pragma once

namespace skein::benchmarks {

/// The peer that measures a Head and its CSPs, all in one process. Knows `bind COUNT` (so many CSPs
/// from now on), `direct COUNT` and `perform STRATEGY COUNT`, whose answers are `times`: of calls
/// of a CSP's operation by a proxy, on the calling thread, and of tasks that a session with that
/// strategy hands to the Head.
void perform_tasks();

}  // namespace skein::benchmarks
