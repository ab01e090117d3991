#include "heartbeats.h"

#include <dds/ddsi/ddsi_domaingv.h>

void skein_set_heartbeat_intervals(struct ddsi_domaingv* domain, int64_t first, int64_t longest) {
  __atomic_store_n(&domain->config.const_hb_intv_sched, first, __ATOMIC_RELAXED);
  __atomic_store_n(&domain->config.const_hb_intv_sched_max, longest, __ATOMIC_RELAXED);
}
