#include "endpoints.h"

#include <stdio.h>
#include <stdlib.h>

enum { kDomain = 17 };

// GenerateKeyhash: without it Fast DDS does not understand that an endpoint has left, and waits for
// the lease to end.
static const char kLoopbackAlone[] =
    "<General><Interfaces><NetworkInterface address=\"127.0.0.1\" "
    "multicast=\"false\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>40</MaxAutoParticipantIndex>"
    "<Peers><Peer Address=\"127.0.0.1\"/></Peers></Discovery>"
    "<Internal><GenerateKeyhash>true</GenerateKeyhash></Internal>";

dds_return_t checked(dds_return_t result, const char* what) {
  if (result >= 0) return result;
  fprintf(stderr, "%s: %s\n", what, dds_strretcode(-result));
  exit(2);
}

static dds_qos_t* make_qos(void) {
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(5));
  dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_data_representation(qos, 1, &xcdr1);
  return qos;
}

Endpoints open_endpoints(const dds_topic_descriptor_t* written_type, const char* written_topic,
                         const dds_topic_descriptor_t* read_type, const char* read_topic) {
  checked(dds_create_domain(kDomain, kLoopbackAlone), "domain");
  dds_qos_t* qos = make_qos();
  Endpoints made;
  made.participant = checked(dds_create_participant(kDomain, NULL, NULL), "participant");
  const dds_entity_t written = checked(
      dds_create_topic(made.participant, written_type, written_topic, qos, NULL), written_topic);
  const dds_entity_t read =
      checked(dds_create_topic(made.participant, read_type, read_topic, qos, NULL), read_topic);
  made.writer = checked(dds_create_writer(made.participant, written, qos, NULL), "writer");
  made.reader = checked(dds_create_reader(made.participant, read, qos, NULL), "reader");
  made.waitset = checked(dds_create_waitset(made.participant), "waitset");
  const dds_entity_t unread =
      checked(dds_create_readcondition(made.reader, DDS_ANY_STATE), "read condition");
  checked(dds_waitset_attach(made.waitset, unread, 0), "waitset");
  dds_delete_qos(qos);
  return made;
}

void close_endpoints(const Endpoints* endpoints) { dds_delete(endpoints->participant); }

bool take_sample(const Endpoints* endpoints, void* sample, int patience_ms) {
  const dds_time_t end = dds_time() + DDS_MSECS(patience_ms);
  while (dds_time() < end) {
    dds_sample_info_t info;
    const dds_return_t taken = checked(dds_take(endpoints->reader, &sample, &info, 1, 1), "take");
    if (taken == 1 && info.valid_data) return true;
    if (taken == 0) checked(dds_waitset_wait_until(endpoints->waitset, NULL, 0, end), "wait");
  }
  return false;
}
