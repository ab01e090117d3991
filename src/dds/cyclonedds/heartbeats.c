#include "heartbeats.h"

// ddsi_endpoint.h does not include what it needs.
// clang-format off
#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity.h>
#include <dds/ddsi/q_hbcontrol.h>
#include <dds/ddsi/ddsi_endpoint.h>
// clang-format on
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/q_thread.h>
#include <dds/ddsi/q_xevent.h>

void skein_set_heartbeat_intervals(struct ddsi_domaingv* domain, int64_t first, int64_t longest) {
  __atomic_store_n(&domain->config.const_hb_intv_sched, first, __ATOMIC_RELAXED);
  __atomic_store_n(&domain->config.const_hb_intv_sched_max, longest, __ATOMIC_RELAXED);
}

void skein_ask_for_acknowledgment(struct ddsi_domaingv* domain, const ddsi_guid_t* writer) {
  struct thread_state* const self = lookup_thread_state();
  thread_state_awake(self, domain);  // nothing is freed until this thread is asleep
  struct ddsi_writer* const found = entidx_lookup_writer_guid(domain->entity_index, writer);
  if (found && found->heartbeat_xevent) {
    ddsrt_mutex_lock(&found->e.lock);
    // As if it had been silent for long: its next heartbeat is due, and wants an answer.
    found->hbcontrol.t_of_last_write.v = 0;
    found->hbcontrol.t_of_last_hb.v = 0;
    found->hbcontrol.tsched = ddsrt_time_monotonic();
    resched_xevent_if_earlier(found->heartbeat_xevent, found->hbcontrol.tsched);
    ddsrt_mutex_unlock(&found->e.lock);
  }
  thread_state_asleep(self);
}
