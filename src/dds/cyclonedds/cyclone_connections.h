#pragma once

#include <stddef.h>

struct ddsi_domaingv;
struct ddsi_tran_conn;

#ifdef __cplusplus
extern "C" {
#endif

#define SKEIN_MOST_CONNECTIONS 4

/// The connections from which a domain of Cyclone DDS receives, each once; returns how many. 0
/// where the domain does not look as those of version 0.10 do. Its header is C only.
size_t skein_cyclone_connections(struct ddsi_domaingv* domain,
                                 struct ddsi_tran_conn* found[SKEIN_MOST_CONNECTIONS]);

#ifdef __cplusplus
}
#endif
