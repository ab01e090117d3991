#include "proxy_leases.h"

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_proxy_participant.h>
#include <dds/ddsi/q_lease.h>
#include <dds/ddsi/q_thread.h>
#include <dds/ddsrt/time.h>

static const int64_t kNotRegistered = INT64_MIN;  // TSCHED_NOT_ON_HEAP in q_lease.c

static void lengthen(struct lease* each, int64_t factor, ddsrt_etime_t now) {
  each->tdur *= factor;
  ddsrt_atomic_st64(&each->tend, (uint64_t)(now.v + each->tdur));
}

int64_t skein_lengthen_lease(struct ddsi_domaingv* domain, const ddsi_guid_t* participant,
                             int64_t factor) {
  struct thread_state* const self = lookup_thread_state();
  int64_t announced = 0;
  thread_state_awake(self, domain);
  struct ddsi_proxy_participant* const proxy =
      entidx_lookup_proxy_participant_guid(domain->entity_index, participant);
  struct lease* const shortest =
      proxy && proxy->owns_lease ? ddsrt_atomic_ldvoidp(&proxy->minl_auto) : NULL;
  if (shortest && shortest->tsched.v == kNotRegistered && shortest->tdur < DDS_INFINITY / factor) {
    const ddsrt_etime_t now = ddsrt_time_elapsed();
    announced = shortest->tdur;
    lengthen(proxy->lease, factor, now);
    lengthen(shortest, factor, now);
  }
  thread_state_asleep(self);
  return announced;
}

int64_t skein_silence(struct ddsi_domaingv* domain, const ddsi_guid_t* participant) {
  struct thread_state* const self = lookup_thread_state();
  int64_t silence = 0;
  thread_state_awake(self, domain);
  struct ddsi_proxy_participant* const proxy =
      entidx_lookup_proxy_participant_guid(domain->entity_index, participant);
  const struct lease* const shortest = proxy ? ddsrt_atomic_ldvoidp(&proxy->minl_auto) : NULL;
  if (shortest) {
    const int64_t end = (int64_t)ddsrt_atomic_ld64(&shortest->tend);
    if (end != DDS_NEVER) silence = ddsrt_time_elapsed().v - (end - shortest->tdur);
  }
  thread_state_asleep(self);
  return silence;
}

void skein_give_up(struct ddsi_domaingv* domain, const ddsi_guid_t* participant) {
  struct thread_state* const self = lookup_thread_state();
  thread_state_awake(self, domain);
  ddsi_delete_proxy_participant_by_guid(domain, participant, ddsrt_time_wallclock(), 1);
  thread_state_asleep(self);
}
