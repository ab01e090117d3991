#include "proxy_leases.h"

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_proxy_endpoint.h>
#include <dds/ddsi/ddsi_proxy_participant.h>
#include <dds/ddsi/q_lease.h>
#include <dds/ddsi/q_rtps.h>
#include <dds/ddsi/q_thread.h>
#include <dds/ddsrt/time.h>
#include <stddef.h>

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

static const ddsi_guid_t* guid_of(const struct ddsi_proxy_endpoint_common* endpoint) {
  const char* const begin = (const char*)endpoint - offsetof(struct ddsi_generic_proxy_endpoint, c);
  return &((const struct ddsi_generic_proxy_endpoint*)begin)->e.guid;
}

void skein_give_up(struct ddsi_domaingv* domain, const ddsi_guid_t* participant,
                   void (*note)(void* argument, const ddsi_guid_t* endpoint), void* argument) {
  struct thread_state* const self = lookup_thread_state();
  thread_state_awake(self, domain);  // nothing is freed until this thread is asleep
  struct ddsi_proxy_participant* const proxy =
      entidx_lookup_proxy_participant_guid(domain->entity_index, participant);
  ddsi_delete_proxy_participant_by_guid(domain, participant, ddsrt_time_wallclock(), 1);
  if (proxy) {
    ddsrt_mutex_lock(&proxy->e.lock);
    for (const struct ddsi_proxy_endpoint_common* each = proxy->endpoints; each;
         each = each->next_ep) {
      note(argument, guid_of(each));
    }
    ddsrt_mutex_unlock(&proxy->e.lock);
  }
  thread_state_asleep(self);
}

static bool is_left_over(const struct ddsi_proxy_endpoint_common* endpoint) {
  ddsrt_mutex_lock(&endpoint->proxypp->e.lock);
  const bool left_over = endpoint->proxypp->deleting;
  ddsrt_mutex_unlock(&endpoint->proxypp->e.lock);
  return left_over;
}

static bool is_writer(const ddsi_guid_t* endpoint) {
  const uint32_t kind = endpoint->entityid.u & NN_ENTITYID_KIND_MASK;
  return kind == NN_ENTITYID_KIND_WRITER_WITH_KEY || kind == NN_ENTITYID_KIND_WRITER_NO_KEY;
}

void skein_delete_left_over(struct ddsi_domaingv* domain, const ddsi_guid_t* endpoint) {
  struct thread_state* const self = lookup_thread_state();
  thread_state_awake(self, domain);
  if (is_writer(endpoint)) {
    const struct ddsi_proxy_writer* const writer =
        entidx_lookup_proxy_writer_guid(domain->entity_index, endpoint);
    if (writer && is_left_over(&writer->c)) {
      ddsi_delete_proxy_writer(domain, endpoint, ddsrt_time_wallclock(), 1);
    }
  } else {
    const struct ddsi_proxy_reader* const reader =
        entidx_lookup_proxy_reader_guid(domain->entity_index, endpoint);
    if (reader && is_left_over(&reader->c)) {
      ddsi_delete_proxy_reader(domain, endpoint, ddsrt_time_wallclock(), 1);
    }
  }
  thread_state_asleep(self);
}
