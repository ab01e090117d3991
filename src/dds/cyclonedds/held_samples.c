#include "held_samples.h"

// ddsi_endpoint.h does not include what it needs.
// clang-format off
#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity.h>
#include <dds/ddsi/q_hbcontrol.h>
#include <dds/ddsi/ddsi_endpoint.h>
// clang-format on
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/q_thread.h>
#include <dds/ddsi/q_whc.h>

uint64_t skein_held_samples(struct ddsi_domaingv* domain, const ddsi_guid_t* writer) {
  struct thread_state* const self = lookup_thread_state();
  struct whc_state held = {0, 0, 0};
  thread_state_awake(self, domain);  // nothing is freed until this thread is asleep
  const struct ddsi_writer* const found = entidx_lookup_writer_guid(domain->entity_index, writer);
  if (found) whc_get_state(found->whc, &held);
  thread_state_asleep(self);
  return WHCST_ISEMPTY(&held) ? 0 : (uint64_t)(held.max_seq - held.min_seq + 1);
}
