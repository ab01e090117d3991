#include "cyclone_connections.h"

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_tran.h>

size_t skein_cyclone_connections(struct ddsi_domaingv* domain,
                                 struct ddsi_tran_conn* found[SKEIN_MOST_CONNECTIONS]) {
  struct ddsi_tran_conn* const all[SKEIN_MOST_CONNECTIONS] = {
      domain->disc_conn_uc, domain->data_conn_uc, domain->disc_conn_mc, domain->data_conn_mc};
  size_t count = 0;
  for (size_t i = 0; i < SKEIN_MOST_CONNECTIONS; ++i) {
    size_t known = 0;
    while (known < count && found[known] != all[i]) ++known;
    if (all[i] == NULL || known < count) continue;
    if (all[i]->m_base.gv != domain || all[i]->m_factory != domain->m_factory || all[i]->m_stream ||
        all[i]->m_read_fn == NULL) {
      return 0;
    }
    found[count++] = all[i];
  }
  return count;
}
