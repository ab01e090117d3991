#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <stdint.h>

struct ddsi_domaingv;

#ifdef __cplusplus
extern "C" {
#endif

/// Sets HeartbeatInterval and its `max`, in ns, of a domain of Cyclone DDS 0.10 that runs: each
/// writer goes by them from its next heartbeat on. On any thread.
void skein_set_heartbeat_intervals(struct ddsi_domaingv* domain, int64_t first, int64_t longest);

/// Has a reliable writer ask its readers for acknowledgment at once. By itself it asks after a
/// pause of HeartbeatInterval, or when half of WhcHigh waits: never, who writes little without a
/// pause. On any thread that may call Cyclone.
void skein_ask_for_acknowledgment(struct ddsi_domaingv* domain, const ddsi_guid_t* writer);

#ifdef __cplusplus
}
#endif
