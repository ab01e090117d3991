#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_guid.h>

/// The leases of participants found, inside Cyclone 0.10, whose headers are C alone.
#ifdef __cplusplus
extern "C" {
#endif

struct ddsi_domaingv;

/// Multiplies the time after which Cyclone gives the participant up, where Cyclone does not watch
/// it yet (within the listener that is told of it). Returns what it was, in ns; 0 where it was left
/// alone.
int64_t skein_lengthen_lease(struct ddsi_domaingv* domain, const ddsi_guid_t* participant,
                             int64_t factor);

/// For how many ns nothing was heard of the participant; 0 where it is unknown or has no end.
int64_t skein_silence(struct ddsi_domaingv* domain, const ddsi_guid_t* participant);

/// As if its lease had expired. `note` is called for each endpoint of the participant.
void skein_give_up(struct ddsi_domaingv* domain, const ddsi_guid_t* participant,
                   void (*note)(void* argument, const ddsi_guid_t* endpoint), void* argument);

/// Deletes the endpoint where it was left over when its participant was given up. An endpoint that
/// another thread is making belongs to the participant before it can be found, and so may escape
/// its deletion; it stays then, and with it the participant, and Cyclone never again listens to an
/// announcement of that participant. (Later versions than 0.10 look once more themselves.)
void skein_delete_left_over(struct ddsi_domaingv* domain, const ddsi_guid_t* endpoint);

#ifdef __cplusplus
}
#endif
