#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <stdint.h>

struct ddsi_domaingv;

#ifdef __cplusplus
extern "C" {
#endif

/// How many samples a writer of Cyclone DDS 0.10 holds: those that wait for acknowledgment and, of
/// a transient-local one, those that late joiners will get. 0 where there is no such writer. On any
/// thread that may call Cyclone.
uint64_t skein_held_samples(struct ddsi_domaingv* domain, const ddsi_guid_t* writer);

#ifdef __cplusplus
}
#endif
