#pragma once

#include <stdint.h>

struct ddsi_domaingv;

#ifdef __cplusplus
extern "C" {
#endif

/// Sets HeartbeatInterval and its `max`, in ns, of a domain of Cyclone DDS 0.10 that runs: each
/// writer goes by them from its next heartbeat on. On any thread.
void skein_set_heartbeat_intervals(struct ddsi_domaingv* domain, int64_t first, int64_t longest);

#ifdef __cplusplus
}
#endif
